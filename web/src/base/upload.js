// SPDX-License-Identifier: GPL-3.0-or-later
// A form with files on its way to the service, with its progress; only XMLHttpRequest tells that.
import { Away, Refusal, address, connection } from './api.js';

/** What a refused recording says about itself. */
export class RefusedRecording extends Refusal {
  /** @param {Api.Problem & Partial<Api.MeasurementOfFile>} problem */
  constructor(problem) {
    super(422, problem);
    this.findings = problem.findings ?? [];
    this.notes = problem.notes ?? [];
    this.layout = problem.layout ?? null;
  }
}

/**
 * @param {string} path @param {FormData} form @param {(fraction: number) => void} tell
 * @param {AbortSignal} [signal]
 * @returns {Promise<{ status: number, data: Api.Measurement }>}
 */
export function upload(path, form, tell, signal) {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open('POST', address(path));
    request.responseType = 'text';
    request.upload.addEventListener('progress', event =>
      tell(event.lengthComputable && event.total ? event.loaded / event.total : 0),
    );
    request.addEventListener('load', () => {
      let data;
      try {
        data = JSON.parse(request.responseText);
      } catch {
        reject(new Refusal(500, { title: 'The answer of the service cannot be read.' }));
        return;
      }
      if (request.status < 400) resolve({ status: request.status, data });
      else reject(data?.findings ? new RefusedRecording(data) : new Refusal(request.status, data));
    });
    request.addEventListener('error', () => {
      connection.lost();
      reject(new Away());
    });
    request.addEventListener('abort', () => reject(new DOMException('Stopped.', 'AbortError')));
    signal?.addEventListener('abort', () => request.abort());
    request.send(form);
  });
}
