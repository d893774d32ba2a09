// SPDX-License-Identifier: GPL-3.0-or-later
// What the page makes of the documents of the API; Api itself is written from OpenAPI when the page is built (types.mjs).
declare namespace Page {
  /** The same with everything known, and with everything known down to its numbers. */
  type Filled<T> = { [K in keyof T]: NonNullable<T[K]> };
  type Known<T> = T extends (infer E)[]
    ? Known<NonNullable<E>>[]
    : T extends object
      ? { [K in keyof T]: Known<NonNullable<T[K]>> }
      : T;
  /** What the page asks for: with the design, and of a pair that was prepared, so that its geometry is whole. */
  type Result = Omit<Api.Result, 'design' | 'geometry'> & { design: Api.ResolvedDesign; geometry: Known<Api.Geometry> };
  /** One load case of a result. */
  type LoadCase = Api.LoadCaseResult;
  /** A design, as it was typed or as it was resolved. */
  type Design = Api.Design | Api.ResolvedDesign | (Omit<Api.Design, 'modification'> & { modification: Api.Modification });
  /** What a stream tells of a job: what has changed of it, or that it is gone. */
  type JobEvent = Partial<Api.Job> & { id: number; deleted?: boolean };
  /** What names a load case; a document may state its power in place of its torque. */
  type Loading = { torque_Nm?: number; power_kW?: number | null; speed_rpm: number; name?: string };
  type End = 'left' | 'right';
  type Member = 'pinion' | 'gear';
  /** A number, or the word that there is none. */
  type Reading = number | null;
  /** A map over the flank, as far as an answer has it. */
  type Pattern = Filled<Pick<Api.ContactPattern, 's_mm' | 'eta_mm'>> &
    Pick<Api.ContactPattern, 'right_eta_mm'> & { left: PatternEnd; right?: PatternEnd };
  type PatternEnd = Filled<Api.ContactPatternEnd>;
  /** Values of a curve, with gaps. */
  type Curve = Reading[];
}
