#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a service has to stand, more of it than a check has time for; run by hand.

usage: storm.py PROGRAM kill [KILLS] | flip [FLIPS] | load [MINUTES] | streams [STREAMS] | restore [ARCHIVES]

kill     SIGKILL at random moments while designs, recordings, searches, studies, tolerance analyses and preparations are
         ordered: what was answered 201 or 202 is there afterwards, and jobs end with what an undisturbed server gives
flip     bits turned in what is kept, twenty per start: every answer is the one of before or an error
load     mixed requests from sixteen clients: requests per second, memory, descriptors
streams  event streams and idle connections: what-if questions beside them and alone
restore  archives made while the server works, each restored and compared
"""

import atexit
import ctypes
import hashlib
import http.client
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

PROGRAM = sys.argv[1] if len(sys.argv) > 1 else "easeoff"
COARSE = {"positions": 16, "cells_per_line": 6, "sector_teeth": 3, "neighbour_coupling": False, "layers": 6}
COARSE |= {"flank_rows": 4, "fillet_elements": 6, "harmonics": 6, "te_harmonics": 6}
BOUNDARY = "storm"
GONE = (OSError, http.client.HTTPException, json.JSONDecodeError)


def design(torque=400.0, **more):
    """No pair of a paper's; torque makes it one that nobody has asked about."""
    pair = {"pinion_teeth": 23, "gear_teeth": 57, "normal_module_mm": 4, "helix_angle_deg": 27, "face_width_mm": 40}
    return {"gear_pair": pair, "load_cases": [{"torque_Nm": torque, "speed_rpm": 1500}], "resolution": COARSE, **more}


STOP_SECONDS = 10  # that a server may take after SIGTERM, whatever is in its queue


def end_with_parent():
    """A server whose script is ended, however, ends too: it would go on with its queue for hours."""
    PR_SET_PDEATHSIG = 1
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


class Server:
    """A server on a data folder of its own; requests may fail while it is not there."""

    def __init__(self, folder, *options):
        self.folder, self.options, self.process, self.port = Path(folder), options, None, 0

    def start(self):
        command = [PROGRAM, "serve", "--listen", "127.0.0.1:0", "--data", str(self.folder), "--quiet", *self.options]
        command += ["--questions-at-once", "100000", "--starts-at-once", "100000", "--attempts", "1000"]
        with open(self.folder.parent / "server.log", "ab") as log:
            self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log, preexec_fn=end_with_parent)
        atexit.register(self.process.kill)
        line = self.process.stdout.readline().decode()
        self.port = int(line.split(":")[3].rstrip("/\n")) if line.startswith("easeoff: http") else 0
        return self.port > 0

    def kill(self, how=signal.SIGKILL):
        self.process.send_signal(how)
        self.process.wait(STOP_SECONDS)
        self.process.stdout.close()
        atexit.unregister(self.process.kill)

    def ask(self, method, path, document=None, headers=None, body=None, timeout=60):
        """Status, headers, bytes."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout)
        try:
            headers = dict(headers or {})
            if document is not None:
                body = json.dumps(document).encode()
                headers["Content-Type"] = "application/json"
            connection.request(method, "/api/v1" + path, body, headers)
            reply = connection.getresponse()
            return reply.status, reply.headers, reply.read()
        finally:
            connection.close()

    def json(self, method, path, document=None, **more):
        status, _, data = self.ask(method, path, document, **more)
        if status >= 300:
            raise OSError(f"{method} {path}: {status} {data[:200]!r}")
        return json.loads(data)


def lasting(data):
    """A result less what depends on the clock and on how often it was begun."""
    document = json.loads(data)
    document.pop("run", None)
    (document.get("best") or {}).get("result", {}).pop("timing_ms", None)
    return json.dumps(document, sort_keys=True)


def recording(server):
    """A rig file of the program's own, and the form that uploads it."""
    order = {"design": design(), "rig": {"turns": 20, "sample_rate_Hz": 5000}}
    status, _, data = server.ask("POST", "/rig", order, headers={"Prefer": "wait=60"})
    if status != 200:
        raise OSError(f"no recording: {status} {data[:300]!r}")
    return data


def form(data, **fields):
    parts = [f'--{BOUNDARY}\r\nContent-Disposition: form-data; name="{k}"\r\n\r\n{v}\r\n'.encode() for k, v in fields.items()]
    head = f'--{BOUNDARY}\r\nContent-Disposition: form-data; name="file"; filename="r.csv"\r\n\r\n'.encode()
    return b"".join(parts) + head + data + f"\r\n--{BOUNDARY}--\r\n".encode()


def post_recording(server, data, design_id):
    headers = {"Content-Type": f"multipart/form-data; boundary={BOUNDARY}"}
    return server.ask("POST", "/measurements", headers=headers, body=form(data, design=design_id, label="modified", torque_Nm=400, speed_rpm=1500))


def shortened(rig, number):
    """A recording of its own: equal files are one measurement."""
    return b"\n".join(rig.split(b"\n")[: -2 - number % 900]) + b"\n"


ORDERS = {
    "optimize": lambda torque: ("/jobs", {"kind": "optimize", "design": design(torque, optimization={"true_evaluations": 60})}),
    "tolerance": lambda torque: ("/jobs", {"kind": "tolerance", "design": design(torque, tolerance={"pairs": 150, "class": 5, "preset": "iso_class"})}),
    "study": lambda torque: ("/studies", {"design": design(torque), "vary": [{"key": "modification.pinion.*.tip_relief_um", "from": 0, "to": 30, "points": 60}]}),
    "prepare": lambda torque: ("/jobs", {"kind": "prepare", "design": design(400.0, gear_pair=design()["gear_pair"] | {"face_width_mm": 30 + torque / 100})}),
}


def outcome_of(server, kind, job):
    """What a job that is done came to, as text."""
    if kind == "prepare":
        return "done"
    path = f"/studies/{job}/table.csv" if kind == "study" else f"/jobs/{job}/result"
    status, _, data = server.ask("GET", path)
    if status != 200:
        raise OSError(f"{path}: {status}")
    return data.decode() if kind == "study" else lasting(data)


class Promises:
    """What a server has taken, by one thread that orders and one that kills."""

    def __init__(self, server, rig):
        self.server, self.rig = server, rig
        self.designs, self.recordings, self.jobs, self.ended = {}, {}, {}, {}
        self.number, self.attempts = 0, 0

    def order(self):
        """One thing of any kind."""
        self.number += 1
        number, server = self.number, self.server
        kind = random.choice(("design", "design", "recording", "cancel", *ORDERS))
        if kind == "design":
            status, headers, data = server.ask("POST", "/designs", {"name": f"design {number}", "design": design(100 + number)})
            if status == 201:
                self.designs[json.loads(data)["id"]] = json.loads(data)["design"]
        elif kind == "recording" and self.designs:
            rig = shortened(self.rig, number)
            status, _, data = post_recording(server, rig, min(self.designs))
            if status == 201:
                self.recordings[json.loads(data)["id"]] = hashlib.sha256(rig).hexdigest()
        elif kind in ORDERS and kind not in [k for k, _ in self.jobs.values()]:
            torque = 300 + number % 500
            path, document = ORDERS[kind](torque)
            headers = {"Idempotency-Key": f"{kind}-{number}"}
            status, _, data = server.ask("POST", path, document, headers=headers)
            if status == 202:
                self.jobs[json.loads(data)["id"]] = (kind, torque)

    def look(self):
        """Jobs that have ended are compared later."""
        for job, (kind, torque) in list(self.jobs.items()):
            state = self.server.json("GET", f"/jobs/{job}")
            if state["state"] == "done":
                self.ended[job] = (kind, torque)
                del self.jobs[job]
            elif state["state"] in ("failed", "cancelled"):
                raise AssertionError(f"job {job} ({kind}) is {state['state']}: {state['error']}")

    def check(self, how_many):
        """Everything that was promised, or some of it."""
        for which, want in random.sample(list(self.designs.items()), min(how_many, len(self.designs))):
            assert self.server.json("GET", f"/designs/{which}")["design"] == want, f"design {which}"
        for which, want in random.sample(list(self.recordings.items()), min(how_many, len(self.recordings))):
            status, _, data = self.server.ask("GET", f"/measurements/{which}/file")
            assert status == 200 and hashlib.sha256(data).hexdigest() == want, f"recording {which}"


def storm_of_kills(folder, kills):
    server = Server(folder / "data")
    server.folder.mkdir()
    server.start()
    promises = Promises(server, recording(server))
    begun, slowest, starts = time.time(), 0.0, 0.0
    for kill in range(1, kills + 1):
        end = threading.Event()

        def keep_ordering():
            while not end.is_set():
                try:
                    promises.order()
                except GONE:
                    return

        worker = threading.Thread(target=keep_ordering)
        worker.start()
        time.sleep(random.expovariate(1 / 0.5))
        server.kill()
        end.set()
        worker.join()
        start = time.time()
        assert server.start(), f"no start after kill {kill}"
        slowest, starts = max(slowest, time.time() - start), starts + time.time() - start
        promises.look()
        promises.check(8)
        if kill % 25 == 0:
            print(f"{kill} kills, {time.time() - begun:.0f} s: {len(promises.designs)} designs, {len(promises.recordings)} recordings, "
                  f"{len(promises.ended)} jobs ended, start {starts / kill:.2f} s (slowest {slowest:.1f} s)", flush=True)
    promises.check(10**9)
    while promises.jobs:
        time.sleep(0.5)
        promises.look()
    chosen = random.sample(sorted(promises.ended), min(24, len(promises.ended)))
    outcomes = {job: outcome_of(server, promises.ended[job][0], job) for job in chosen}
    server.kill(signal.SIGTERM)
    doctor = subprocess.run([PROGRAM, "doctor", "--data", str(server.folder)], capture_output=True, text=True)
    assert doctor.returncode == 0, doctor.stdout
    quiet = Server(folder / "undisturbed")
    quiet.folder.mkdir()
    quiet.start()
    for job in chosen:
        kind, torque = promises.ended[job]
        path, document = ORDERS[kind](torque)
        same = quiet.json("POST", path, document)["id"]
        while quiet.json("GET", f"/jobs/{same}")["state"] != "done":
            time.sleep(0.2)
        assert outcome_of(quiet, kind, same) == outcomes[job], f"{kind} {torque} differs"
    quiet.kill(signal.SIGTERM)
    kinds = [promises.ended[job][0] for job in promises.ended]
    print(f"{kills} kills: nothing lost of {len(promises.designs)} designs, {len(promises.recordings)} recordings and "
          f"{ {kind: kinds.count(kind) for kind in ORDERS} } jobs; {len(chosen)} of them as undisturbed; doctor finds nothing")


def fill(server):
    """A little of everything; the addresses that are asked afterwards."""
    rig = recording(server)
    for number in range(12):
        server.json("POST", "/designs", {"name": f"design {number}", "design": design(100 + number)})
    for number in range(2):
        status, _, data = post_recording(server, shortened(rig, number), 1)
        assert status == 201, data
    asked = [f"/designs/{n}" for n in range(1, 13)] + ["/designs", "/measurements", "/history"]
    asked += [f"/measurements/{n}" + tail for n in (1, 2) for tail in ("", "/file")]
    for kind in ("optimize", "tolerance", "study"):
        path, document = ORDERS[kind](333)
        job = server.json("POST", path, document)["id"]
        while server.json("GET", f"/jobs/{job}")["state"] != "done":
            time.sleep(0.1)
        asked += [f"/jobs/{job}", f"/studies/{job}/table.csv" if kind == "study" else f"/jobs/{job}/result"]
        asked += {"optimize": [f"/jobs/{job}/history", f"/jobs/{job}/path"], "tolerance": [f"/jobs/{job}/pairs"], "study": []}[kind]
    return asked


def flip_bits(folder, count):
    files = [f for f in folder.rglob("*") if f.is_file() and f.suffix not in (".lock",) and f.stat().st_size]
    weights = [min(f.stat().st_size, 1 << 20) for f in files]
    for _ in range(count):
        file = random.choices(files, weights)[0]
        with open(file, "r+b") as handle:
            place = random.randrange(file.stat().st_size)
            handle.seek(place)
            byte = handle.read(1)[0]
            handle.seek(place)
            handle.write(bytes([byte ^ 1 << random.randrange(8)]))


def flip(folder, flips):
    server = Server(folder / "whole")
    server.folder.mkdir()
    server.start()
    asked = fill(server)
    question = design(333)
    server.kill(signal.SIGTERM)
    assert not (server.folder / "easeoff.db-wal").exists(), "a stop in order leaves no journal"
    shutil.copytree(server.folder, folder / "pristine")  # asking about a pair orders its preparation
    server.start()

    def answers(of):
        found = {path: of.ask("GET", path)[::2] for path in asked}
        status, _, data = of.ask("POST", "/analyze?rating=0", question, headers={"Prefer": "wait=60"})
        document = json.loads(data)
        document.pop("timing_ms", None), document.pop("warnings", None)
        return found | {"analysis": (status, json.dumps(document, sort_keys=True))}

    truth = answers(server)
    server.kill(signal.SIGTERM)
    counts = {"same": 0, "errors": 0, "missing": 0, "wrong": 0, "not started": 0}
    done = 0
    while done < flips:
        shutil.rmtree(folder / "data", ignore_errors=True)
        shutil.copytree(folder / "pristine", folder / "data")
        flip_bits(folder / "data", 20)
        done += 20
        damaged = Server(folder / "data")
        if not damaged.start():
            damaged.process.wait()
            counts["not started"] += 1
            continue
        for path, (status, data) in answers(damaged).items():
            right = truth[path]
            what = ("same" if (status, data) == right else "errors" if status >= 500 else "missing" if status == 404 else "wrong")
            counts[what] += 1
            if what == "wrong":
                at = next((i for i, (a, b) in enumerate(zip(data, right[1])) if a != b), min(len(data), len(right[1])))
                print(f"wrong: {path} {status}, from {at}: {data[at - 60:at + 200]!r} in place of {right[1][at - 60:at + 200]!r}", flush=True)
        damaged.kill(signal.SIGTERM)
        if done % 400 == 0:
            print(done, "flips", counts, flush=True)
    print(f"{flips} bits turned: {counts}")
    return counts["wrong"] == 0


def memory_of(process):
    status = Path(f"/proc/{process.pid}/status").read_text()
    return int(status.split("VmRSS:")[1].split()[0]) / 1024, len(os.listdir(f"/proc/{process.pid}/fd"))


def load(folder, minutes):
    server = Server(folder / "data")
    server.folder.mkdir()
    server.start()
    rig = recording(server)
    server.json("POST", "/designs", {"name": "first", "design": design()})
    end, counts, lock = time.time() + 60 * minutes, {}, threading.Lock()

    def one(chance, number):
        if chance < 0.35:
            return server.ask("POST", "/analyze?rating=0&root_stress=0", design(400.0, modification={"pinion": {"left": {"tip_relief_um": number % 40}}}), headers={"Prefer": "wait=30"})
        if chance < 0.45:
            return server.ask("POST", "/check", design(100 + number % 300))
        if chance < 0.60:
            return server.ask("GET", random.choice(("/designs", "/jobs", "/measurements", "/history", "/health", "/metrics", "/openapi.json")))
        if chance < 0.70:
            status, _, data = server.ask("POST", "/designs", {"name": "passing", "design": design(200 + number % 100)})
            return server.ask("DELETE", f"/designs/{json.loads(data)['id']}") if status == 201 else (status, None, data)
        if chance < 0.72:
            status, _, data = post_recording(server, shortened(rig, number), 1)
            return server.ask("DELETE", f"/measurements/{json.loads(data)['id']}") if status == 201 else (status, None, data)
        if chance < 0.74:
            path, document = ORDERS[random.choice(("optimize", "tolerance", "study"))](350 + number % 3)
            status, _, data = server.ask("POST", path, document)
            return server.ask("POST", f"/jobs/{json.loads(data)['id']}/cancel") if status == 202 and random.random() < 0.5 else (status, None, data)
        if chance < 0.80:
            return server.ask("POST", "/export/flank-points", design())
        return server.ask("GET", "/designs/1")

    def client(seed):
        chance = random.Random(seed)
        while time.time() < end:
            try:
                status = one(chance.random(), chance.randrange(10**6))[0]
            except GONE as error:
                status = repr(error)
            with lock:
                counts[status] = counts.get(status, 0) + 1

    threads = [threading.Thread(target=client, args=(seed,)) for seed in range(16)]
    for thread in threads:
        thread.start()
    begun, seen = time.time(), []
    while time.time() < end:
        time.sleep(min(30, max(0.1, end - time.time())))
        seen.append(memory_of(server.process))
        done = sum(counts.values())
        print(f"{time.time() - begun:.0f} s, {done / (time.time() - begun):.1f} requests/s, {seen[-1][0]:.0f} MB, {seen[-1][1]} descriptors, {counts}", flush=True)
    for thread in threads:
        thread.join()
    server.kill(signal.SIGTERM)
    half = seen[len(seen) // 2 :]
    print(f"{minutes} min: {sum(counts.values())} requests, {counts}; memory in the second half {min(m for m, _ in half):.0f} .. "
          f"{max(m for m, _ in half):.0f} MB, descriptors {min(d for _, d in half)} .. {max(d for _, d in half)}")


def streams(folder, count):
    server = Server(folder / "data", "--streams", "4000", "--connections-per-client", "4000")
    server.folder.mkdir()
    server.start()
    question = design(400.0)
    server.ask("POST", "/analyze?rating=0", question, headers={"Prefer": "wait=60"})

    def what_ifs(asked):
        connection, taken = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60), []
        for number in range(asked):
            question["modification"] = {"pinion": {"left": {"tip_relief_um": 5 + number * 0.01}}}
            body = json.dumps(question)
            begun = time.perf_counter()
            connection.request("POST", "/api/v1/analyze?rating=0&root_stress=0&maps=0", body, {"Content-Type": "application/json"})
            reply = connection.getresponse()
            reply.read()
            taken.append(1e3 * (time.perf_counter() - begun))
            assert reply.status == 200
        taken.sort()
        return taken[len(taken) // 2], taken[int(0.99 * len(taken))]

    alone = what_ifs(300)
    held = []
    for number in range(2 * count):
        connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
        connection.request("GET", "/api/v1/events" if number % 2 else "/api/v1/health")
        reply = connection.getresponse()
        assert reply.status == 200, reply.status
        if number % 2 == 0:
            reply.read()
        held.append((connection, reply))
    beside = what_ifs(300)
    again = [None] * 3
    stop = threading.Event()

    def poll():
        while not stop.is_set():
            for connection, _ in held[::2]:
                connection.request("GET", "/api/v1/designs")
                connection.getresponse().read()
                if stop.is_set():
                    return
                time.sleep(0.002)

    poller = threading.Thread(target=poll)
    poller.start()
    server.json("POST", "/jobs", {"kind": "tolerance", "design": design(401, tolerance={"pairs": 100000})})  # events for all
    busy = what_ifs(300)
    stop.set()
    poller.join()
    memory, descriptors = memory_of(server.process)
    server.kill(signal.SIGTERM)
    print(f"what-if alone p50 {alone[0]:.1f} p99 {alone[1]:.1f} ms; beside {count} clients and {count} streams {beside[0]:.1f} {beside[1]:.1f} ms; "
          f"with a job's events to all and clients that ask {busy[0]:.1f} {busy[1]:.1f} ms; {memory:.0f} MB, {descriptors} descriptors")
    _ = again


def restore(folder, archives):
    server = Server(folder / "data")
    server.folder.mkdir()
    server.start()
    promises = Promises(server, recording(server))
    end = threading.Event()

    def keep_ordering():
        while not end.is_set():
            promises.order()

    worker = threading.Thread(target=keep_ordering)
    worker.start()
    for number in range(archives):
        time.sleep(random.uniform(0.2, 1.5))
        before, recordings = dict(promises.designs), dict(promises.recordings)
        archive = folder / f"archive-{number}.tar.gz"
        made = subprocess.run([PROGRAM, "backup", str(archive), "--data", str(server.folder)], capture_output=True, text=True)
        assert made.returncode == 0, made.stderr
        other = Server(folder / f"restored-{number}")
        made = subprocess.run([PROGRAM, "restore", str(archive), "--data", str(other.folder)], capture_output=True, text=True)
        assert made.returncode == 0, made.stderr
        doctor = subprocess.run([PROGRAM, "doctor", "--data", str(other.folder)], capture_output=True, text=True)
        assert doctor.returncode == 0, doctor.stdout
        assert other.start()
        for which, want in before.items():
            assert other.json("GET", f"/designs/{which}")["design"] == want
        for which, want in recordings.items():
            assert hashlib.sha256(other.ask("GET", f"/measurements/{which}/file")[2]).hexdigest() == want
        other.kill(signal.SIGTERM)
        print(f"archive {number + 1}: {len(before)} designs and {len(recordings)} recordings, {archive.stat().st_size / 1e6:.1f} MB", flush=True)
        shutil.rmtree(other.folder)
        archive.unlink()
    end.set()
    worker.join()
    server.kill(signal.SIGTERM)
    print(f"{archives} archives made under load, restored and compared")


def main():
    what, amount = sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 0
    with tempfile.TemporaryDirectory(prefix="easeoff-storm-") as name:
        folder = Path(name)
        runs = {"kill": (storm_of_kills, 1000), "flip": (flip, 10000), "load": (load, 60), "streams": (streams, 1000), "restore": (restore, 20)}
        run, standard = runs[what]
        return 0 if run(folder, amount or standard) is not False else 1


if __name__ == "__main__":
    sys.exit(main())
