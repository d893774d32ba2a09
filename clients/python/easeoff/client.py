# SPDX-License-Identifier: GPL-3.0-or-later
"""One method per operation of the API; tests/test_client.py compares them with /openapi.json."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Generic, Iterator, Mapping, Sequence, TypeVar, Union, cast
from urllib.parse import quote

from .transport import Event, Reply, Transport, encode_form

if TYPE_CHECKING:
    from . import documents as doc

T = TypeVar("T")
Design = Mapping[str, Any]
Recording = Union[str, "os.PathLike[str]", "tuple[str, bytes]"]

# The longest that the service lets one request wait for a gear pair, seconds.
LONGEST_WAIT = 60
ENDED = ("done", "failed", "cancelled")


def operation(identity: str) -> Callable[[T], T]:
    """Names the operation of the API that a method calls."""

    def mark(method: T) -> T:
        method.operation = identity  # type: ignore[attr-defined]
        return method

    return mark


class JobFailed(Exception):
    """A job ended without a result. job: its document."""

    def __init__(self, job: Mapping[str, Any]):
        self.job = job
        error = job.get("error") or {}
        super().__init__(f"job {job['id']} {job['state']}: {error.get('detail') or 'no result'}")


class Stored(Generic[T]):
    """A document with the version it has: put it back with `replace_design(stored)`."""

    def __init__(self, document: T, tag: str | None):
        self.document = document
        self.tag = tag


class Client:
    """A service at an address.

    address: of the server, as `easeoff serve` prints it. token: when the server asks for one; else $EASEOFF_TOKEN.
    timeout: seconds that one reply may take. What takes a prepared gear pair waits for its preparation up to
    `patience` seconds, then raises TimeoutError; the preparation goes on.
    """

    def __init__(
        self,
        address: str = "http://127.0.0.1:8080",
        token: str | None = None,
        timeout: float = 120,
        patience: float = 900,
    ):
        self.transport = Transport(address, token or os.environ.get("EASEOFF_TOKEN"), timeout)
        self.patience = patience

    # -- the service

    @operation("getHealth")
    def health(self) -> doc.Health:
        """Whether the service works; raises Problem 503 when it does not."""
        return self._json("GET", "/health")

    @operation("getReady")
    def ready(self) -> doc.Health:
        """The same: whether the service can work and keep what it is sent."""
        return self._json("GET", "/health/ready")

    @operation("getLive")
    def live(self) -> doc.Live:
        """That the service answers at all."""
        return self._json("GET", "/health/live")

    @operation("getMetrics")
    def metrics(self) -> str:
        """Counters in the text format of Prometheus."""
        return self.transport.request("GET", "/metrics", accept="text/plain").text

    @operation("getOpenapi")
    def openapi(self) -> dict[str, Any]:
        """The description of the API."""
        return self._json("GET", "/openapi.json")

    @operation("getSchema")
    def schema(self) -> doc.Form:
        """The fields of a design with units, ranges, defaults and help."""
        return self._json("GET", "/schema")

    @operation("getSession")
    def session(self) -> doc.Session:
        """Whether the service asks for a token, and whether this client has given it."""
        return self._json("GET", "/session")

    # -- designs

    @operation("listExamples")
    def examples(self) -> doc.Examples:
        """The designs to start from."""
        return self._json("GET", "/examples")

    @operation("getExample")
    def example(self, name: str) -> dict[str, Any]:
        """A design to start from, with every key; None where the value is derived from the others."""
        return self._json("GET", f"/examples/{quote(name, safe='')}")

    @operation("listDesigns")
    def designs(self) -> Iterator[doc.ListedDesign]:
        """All stored designs, newest first."""
        return self._pages("/designs")

    @operation("addDesign")
    def add_design(self, design: Design, name: str | None = None) -> Stored[doc.StoredDesign]:
        """Stores a design, under a name of its own if one is given."""
        body = design if name is None else {"name": name, "design": design}
        return self._stored(self.transport.request("POST", "/designs", document=body))

    @operation("getDesign")
    def design(self, id: int) -> Stored[doc.StoredDesign]:
        """A stored design as it came."""
        return self._stored(self.transport.request("GET", f"/designs/{id}"))

    @operation("replaceDesign")
    def replace_design(
        self, id: int, design: Design, name: str | None = None, if_match: str | None = None
    ) -> Stored[doc.StoredDesign]:
        """Replaces a stored design. if_match: the tag of the version that is meant; Problem 412 when it is another."""
        body = design if name is None else {"name": name, "design": design}
        return self._stored(
            self.transport.request("PUT", f"/designs/{id}", document=body, headers={"If-Match": if_match})
        )

    @operation("removeDesign")
    def remove_design(self, id: int, if_match: str | None = None) -> None:
        """Removes a stored design."""
        self.transport.request("DELETE", f"/designs/{id}", headers={"If-Match": if_match})

    @operation("checkDesign")
    def check(self, design: Design, *, units: str | None = None) -> doc.Check:
        """Fills in every default and works out the geometry; Problem 422 names everything that is wrong. units: "inch"
        for lengths in inches, by keys that end in _in."""
        return self._json("POST", "/check", document=design, query={"units": units})

    # -- computations

    @operation("analyze")
    def analyze(
        self,
        design: Design,
        *,
        root_stress: bool = True,
        band: bool = False,
        maps: bool = True,
        histories: bool = False,
        rating: bool = True,
        pitch: bool = True,
        parts: str | None = None,
        curves_of: int | None = None,
        digits: int | None = None,
        units: str | None = None,
        easeoff_lane: str | None = None,
    ) -> doc.Result:
        """One true evaluation. parts, curves_of, digits: leave the rest of a long answer out. units: "inch" for lengths
        in inches. easeoff_lane: a newer question with the same word takes the place of one that waits."""
        flags = {
            "root_stress": root_stress,
            "band": band,
            "maps": maps,
            "histories": histories,
            "rating": rating,
            "pitch": pitch,
        }
        query: dict[str, Any] = {name: int(value) for name, value in flags.items()}
        query.update(parts=parts, curves_of=curves_of, digits=digits, units=units)
        return self._computed("POST", "/analyze", document=design, query=query, lane=easeoff_lane).json

    @operation("sweep")
    def sweep(
        self, request: Mapping[str, Any], *, units: str | None = None, easeoff_lane: str | None = None
    ) -> doc.Sweep:
        """A design over torque or another of its numbers, over speed or both, compared with the unmodified pair. units: as in analyze().

        request: {"design": .., "speed_rpm": {"from": .., "to": .., "points": ..}, "torque_Nm": the same}; in place of
        torque_Nm "vary": {"key": "modification.pinion.left.grid_um.3.4", "from": .., "to": .., "points": ..}.
        """
        return self._computed("POST", "/sweep", document=request, query={"units": units}, lane=easeoff_lane).json

    @operation("tolerance")
    def tolerance(self, design: Design, pairs: int | None = None, *, easeoff_lane: str | None = None) -> doc.Tolerance:
        """Many pairs of a design as they are made: percentiles, what decides, yield, the worst pair.

        design: with its block "tolerance"; pairs: how many, in place of what the block says.
        """
        request = {"design": design, "pairs": pairs}
        return self._computed("POST", "/tolerance", document=request, lane=easeoff_lane).json

    @operation("tolerance")
    def tolerance_job(self, design: Design, pairs: int | None = None, idempotency_key: str | None = None) -> doc.Job:
        """The same as a job, of up to 100000 pairs: job_result() has the document when it is done."""
        headers = {"Prefer": "respond-async", "Idempotency-Key": idempotency_key}
        return self._json("POST", "/tolerance", document={"design": design, "pairs": pairs}, headers=headers)["job"]

    @operation("listExports")
    def exports(self) -> doc.Exports:
        """The formats of exported files."""
        return self._json("GET", "/export")

    @operation("exportDesign")
    def export(
        self,
        format: str,
        design: Design,
        rows: int | None = None,
        columns: int | None = None,
        *,
        units: str | None = None,
    ) -> bytes:
        """A file for another program, as `easeoff export` writes it; rows and columns of a grid of points; units:
        "inch" for tables of columns with lengths in inches and thousandths."""
        path = f"/export/{quote(format, safe='')}"
        query = {"rows": rows, "columns": columns, "units": units}
        return self.transport.request("POST", path, document=design, query=query, accept="*/*").body

    @operation("reportDesign")
    def report(self, design: Design, *, units: str | None = None, easeoff_lane: str | None = None) -> str:
        """One HTML file a reviewer can check, as `easeoff report` writes it; waits while the pair is prepared. units:
        "inch" for lengths in inches."""
        query = {"units": units}
        return self._computed("POST", "/report", document=design, query=query, lane=easeoff_lane, accept="text/html").text

    @operation("importDesign")
    def import_design(
        self,
        file: str | Path | bytes,
        pair: int = 0,
        flank: str | None = None,
        transverse: bool = False,
        reversed: bool = False,
    ) -> doc.Import:
        """A design out of a REXS model or a table (a path, or its content); of several pairs one by its number.

        Problem 422 holds the faults, and under "imported" the pairs to choose from.
        """
        content = file if isinstance(file, bytes) else Path(file).read_bytes()
        query = {"pair": pair, "flank": flank, "transverse": int(transverse), "reversed": int(reversed)}
        return self._json("POST", "/import", query=query, form=("application/octet-stream", content))

    # -- jobs

    @operation("addJob")
    def add_job(self, order: Mapping[str, Any], idempotency_key: str | None = None) -> doc.Job:
        """Orders an optimization, a tolerance analysis or a preparation: {"kind": "optimize", "design": ..}."""
        return self._json("POST", "/jobs", document=order, headers={"Idempotency-Key": idempotency_key})

    @operation("addStudy")
    def add_study(self, order: Mapping[str, Any], idempotency_key: str | None = None) -> doc.Job:
        """Orders a study: {"design": .., "vary": [{"key": "load_cases.1.torque_Nm", "values": [..]}]}."""
        return self._json("POST", "/studies", document=order, headers={"Idempotency-Key": idempotency_key})

    @operation("addReproduction")
    def add_reproduction(
        self, order: Mapping[str, Any] | None = None, idempotency_key: str | None = None
    ) -> doc.Job:
        """Orders the paper's tables and figures compared with ours: {"quick": True}."""
        headers = {"Idempotency-Key": idempotency_key}
        return self._json("POST", "/reproductions", document=order or {}, headers=headers)

    @operation("listJobFiles")
    def job_files(self, id: int) -> list[str]:
        """The names of the files of a reproduction that is done."""
        return self._json("GET", f"/jobs/{id}/files")["items"]

    @operation("getJobFile")
    def job_file(self, id: int, name: str) -> str:
        """One of them: a table as CSV, or the page."""
        return self.transport.request("GET", f"/jobs/{id}/files/{quote(name, safe='')}", accept="*/*").text

    @operation("getStudyCost")
    def study_cost(self, order: Mapping[str, Any]) -> dict[str, Any]:
        """What a study would take: variants, gear pairs, memory, time."""
        return self._json("POST", "/study-cost", document=order)

    @operation("listStudyColumns")
    def study_columns(self, cases: int | None = None, ends: int | None = None) -> dict[str, Any]:
        """The numbers of a result that a study can keep."""
        return self._json("GET", "/study-columns", query={"cases": cases, "ends": ends})

    @operation("getStudy")
    def study(
        self,
        id: int,
        limit: int | None = None,
        cursor: str | None = None,
        filter: str | None = None,
        sort: str | None = None,
        order: str | None = None,
    ) -> dict[str, Any]:
        """A page of the table of a study."""
        return self._json(
            "GET",
            f"/studies/{id}/table",
            query={"limit": limit, "cursor": cursor, "filter": filter, "sort": sort, "order": order},
        )

    @operation("getStudyVariant")
    def study_variant(self, id: int, variant: int) -> dict[str, Any]:
        """The design of one variant, complete."""
        return self._json("GET", f"/studies/{id}/variants/{variant}/design")

    @operation("listJobs")
    def jobs(self, state: str | None = None, kind: str | None = None) -> Iterator[doc.Job]:
        """All jobs, newest first."""
        return self._pages("/jobs", state=state, kind=kind)

    @operation("getJob")
    def job(self, id: int) -> doc.Job:
        """A job with its design."""
        return self._json("GET", f"/jobs/{id}")

    @operation("removeJob")
    def remove_job(self, id: int) -> None:
        """Removes a job that has ended."""
        self.transport.request("DELETE", f"/jobs/{id}")

    @operation("getJobResult")
    def job_result(self, id: int) -> doc.OptimizationResult | doc.Tolerance | doc.Reproduction:
        """What an optimization, a tolerance analysis or a reproduction found."""
        return self._json("GET", f"/jobs/{id}/result")

    @operation("getJobPairs")
    def job_pairs(self, id: int, *, units: str | None = None) -> str:
        """The pairs of a tolerance analysis that is done, as CSV; units: "inch" for lengths in inches."""
        return self.transport.request("GET", f"/jobs/{id}/pairs", query={"units": units}, accept="text/csv").text

    @operation("getJobFront")
    def job_front(self, id: int, *, units: str | None = None) -> str:
        """The Pareto front that a search by nsga2 found, as CSV; units: "inch" for lengths in inches."""
        return self.transport.request("GET", f"/jobs/{id}/front", query={"units": units}, accept="text/csv").text

    @operation("getJobGenerations")
    def job_generations(self, id: int) -> doc.Generations:
        """The convergence of an optimization as columns, also while it runs."""
        return self._json("GET", f"/jobs/{id}/generations")

    @operation("cancelJob")
    def cancel_job(self, id: int) -> doc.Job:
        """Stops a job; one that runs keeps what it found."""
        return self._json("POST", f"/jobs/{id}/cancel")

    @operation("retryJob")
    def retry_job(self, id: int) -> doc.Job:
        """Queues a failed or cancelled job again."""
        return self._json("POST", f"/jobs/{id}/retry")

    @operation("cloneJob")
    def clone_job(self, id: int, change: Mapping[str, Any] | None = None) -> doc.Job:
        """Orders the same once more, with what `change` says."""
        return self._json("POST", f"/jobs/{id}/clone", document=change or {})

    @operation("getJobHistory")
    def job_history(self, id: int) -> Iterator[doc.JobHistoryRow]:
        """The true evaluations of an optimization in its order."""
        return self._pages(f"/jobs/{id}/history")

    @operation("pruneHistory")
    def prune(self, what: Mapping[str, Any]) -> doc.Pruned:
        """Removes rows of the history for good: {"predictions": True}, outdated, damaged, unused, {"problem": 3}."""
        return self._json("POST", "/history/prune", document=what)

    @operation("getJobPath")
    def job_path(self, id: int) -> str:
        """The path of a search as CSV: each individual, whether computed, known or predicted."""
        return self.transport.request("GET", f"/jobs/{id}/path", accept="text/csv").text

    @operation("getEvents")
    def events(self, last_event_id: str | None = None) -> Iterator[Event]:
        """Every change of any job, as it happens; the stream ends with the service."""
        return self.transport.events("/events", last_event_id)

    @operation("getJobEvents")
    def job_events(self, id: int, last_event_id: str | None = None) -> Iterator[Event]:
        """The job as it is (not after `last_event_id`), then every change; ends with the service, or when you stop."""
        return self.transport.events(f"/jobs/{id}/events", last_event_id)

    @operation("getHistory")
    def history(self) -> doc.History:
        """The problems that were worked on with the number of their evaluations, and all jobs."""
        return self._json("GET", "/history")

    @operation("getProblem")
    def problem_rows(self, id: int) -> doc.ProblemRows:
        """Every true evaluation of a problem of the history."""
        return self._json("GET", f"/history/{id}/rows")

    def follow(self, id: int) -> Iterator[doc.Job]:
        """The job each time it changes, its last state included; a broken connection is taken up again."""
        last: str | None = None
        while True:
            try:
                for event in self.job_events(id, last):
                    last = event.id
                    yield event.data
                    if event.data["state"] in ENDED:
                        return
            except OSError:
                time.sleep(1)

    def optimize(
        self, design: Design, *, fresh: bool = False, progress: Callable[[doc.Job], None] | None = None
    ) -> doc.OptimizationResult:
        """Orders a search and waits for what it finds. progress: called with the job whenever it changes."""
        job = self.add_job({"kind": "optimize", "design": design, "fresh": fresh})
        for state in self.follow(job["id"]):
            job = state
            if progress is not None:
                progress(state)
        if not job["has_result"]:
            raise JobFailed(cast("Mapping[str, Any]", job))
        return self.job_result(job["id"])

    # -- the rig

    @operation("listMeasurements")
    def measurements(self, design: int | None = None) -> Iterator[doc.ListedMeasurement]:
        """All measurements, newest first, without their curves; of one design, or of all."""
        return self._pages("/measurements", design=design)

    @operation("addMeasurement")
    def add_measurement(self, *recordings: Recording, **stated: Any) -> doc.Measurement:
        """A recording of two encoders: one file, or the pinion's and then the gear's; what is known of it as keywords.

        A recording is a path, or (file name, content). stated: design (its number), torque_Nm, speed_rpm and the other
        fields of the form MeasurementForm. Problem 422 holds the findings of a recording without a result.
        """
        return self._json("POST", "/measurements", form=encode_form(stated, self._files(recordings)))

    @operation("tryMeasurement")
    def try_measurement(self, *recordings: Recording, **stated: Any) -> doc.MeasurementOfFile:
        """What add_measurement() would find, without keeping anything."""
        return self._json("POST", "/measure", form=encode_form(stated, self._files(recordings)))

    @operation("getMeasurement")
    def measurement(self, id: int) -> doc.Measurement:
        """What was found in a recording: findings, transmission error, orders, RMS."""
        return self._json("GET", f"/measurements/{id}")

    @operation("removeMeasurement")
    def remove_measurement(self, id: int) -> None:
        """Removes a measurement with its files."""
        self.transport.request("DELETE", f"/measurements/{id}")

    @operation("getMeasurementFile")
    def measurement_file(self, id: int, part: int | None = None) -> bytes:
        """The recording as it came."""
        return self.transport.request("GET", f"/measurements/{id}/file", query={"part": part}, accept="*/*").body

    @operation("compareMeasurement")
    def compare_measurement(
        self, id: int, *, units: str | None = None, easeoff_lane: str | None = None
    ) -> doc.Comparison:
        """A measurement compared with the prediction at its torque and measured speed."""
        return self._computed("GET", f"/measurements/{id}/comparison", query={"units": units}, lane=easeoff_lane).json

    @operation("compareDesign")
    def compare_design(
        self, id: int, *, units: str | None = None, easeoff_lane: str | None = None
    ) -> doc.Comparison:
        """All measurements of a design compared with the prediction."""
        return self._computed("GET", f"/designs/{id}/comparison", query={"units": units}, lane=easeoff_lane).json

    @operation("compareWhatIf")
    def compare_what_if(
        self, id: int, design: Design, *, units: str | None = None, easeoff_lane: str | None = None
    ) -> doc.Comparison:
        """What the measurements of a stored design say about another one."""
        path = f"/designs/{id}/comparison"
        return self._computed("POST", path, document=design, query={"units": units}, lane=easeoff_lane).json

    @operation("fitDesign")
    def fit(self, id: int, order: Mapping[str, Any], *, easeoff_lane: str | None = None) -> doc.Fit:
        """Inputs that are not known, fitted to the measurements of a design within ranges."""
        return self._computed("POST", f"/designs/{id}/fit", document=order, lane=easeoff_lane).json

    @operation("recordRig")
    def synthetic_recording(self, order: Mapping[str, Any], *, easeoff_lane: str | None = None) -> str:
        """What two encoders would record of a design: a text file with known truth."""
        return self._computed("POST", "/rig", document=order, lane=easeoff_lane, accept="text/csv").text

    # -- below the methods

    @staticmethod
    def _files(recordings: Sequence[Recording]) -> list[tuple[str, bytes]]:
        return [
            recording if isinstance(recording, tuple) else (Path(recording).name, Path(recording).read_bytes())
            for recording in recordings
        ]

    def _json(self, method: str, path: str, **request: Any) -> Any:
        return self.transport.request(method, path, **request).json

    def _stored(self, reply: Reply) -> Stored[Any]:
        return Stored(reply.json, reply.headers.get("ETag"))

    def _pages(self, path: str, **query: Any) -> Iterator[Any]:
        """The items of all pages; each page names the next one."""
        cursor = None
        while True:
            page = self._json("GET", path, query={**query, "limit": 200, "cursor": cursor})
            yield from page["items"]
            cursor = page["next"]
            if cursor is None:
                return

    def _computed(
        self, method: str, path: str, *, lane: str | None, accept: str = "application/json", **request: Any
    ) -> Reply:
        """Asks until the gear pair is prepared: 202 says that it is not yet."""
        end = time.monotonic() + self.patience
        while True:
            left = end - time.monotonic()
            headers = {"Prefer": f"wait={max(1, min(LONGEST_WAIT, int(left)))}", "Easeoff-Lane": lane}
            begun = time.monotonic()
            reply = self.transport.request(method, path, headers=headers, accept=accept, **request)
            if reply.status != 202:
                return reply
            job = (reply.json or {}).get("job") or {}
            if job.get("state") in ("failed", "cancelled"):
                raise JobFailed(job)
            if time.monotonic() >= end:
                raise TimeoutError(f"The gear pair was not prepared within {self.patience:g} s.")
            if time.monotonic() - begun < 0.2:
                time.sleep(0.2)
