# SPDX-License-Identifier: GPL-3.0-or-later
"""The client against a real service: $EASEOFF is the program. One service for all tests, on a data folder of its own."""

import contextlib
import importlib.util
import inspect
import io
import itertools
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(HERE))

from easeoff import Client, Problem  # noqa: E402
from easeoff.transport import encode_form, read_events  # noqa: E402

# A coarse model: these tests are about the client.
COARSE = {
    "body": "sector", "positions": 16, "cells_per_line": 8, "sector_teeth": 3, "neighbour_coupling": False,
    "layers": 8, "flank_rows": 4, "fillet_elements": 6, "harmonics": 12, "te_harmonics": 8,
}  # fmt: skip

# Operations for browsers, which keep the token in a cookie.
FOR_BROWSERS = {"beginSession", "endSession"}


def load(path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class ClientTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.server = subprocess.Popen(
            [os.environ["EASEOFF"], "serve", "--listen", "127.0.0.1:0", "--quiet", "--data", cls.folder.name],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
        )  # fmt: skip
        address = cls.server.stdout.readline().split()[-1]
        cls.address = address
        cls.client = Client(address, timeout=60, patience=120)

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait(30)
        cls.server.stdout.close()
        cls.folder.cleanup()

    def design(self):
        design = self.client.example("paper-case-a")
        design["resolution"].update(COARSE)
        return design

    def methods(self):
        """Of each operation those that ask for it: more than one where it answers at once or as a job."""
        found = {}
        for _, method in inspect.getmembers(Client, inspect.isfunction):
            if hasattr(method, "operation"):
                found.setdefault(method.operation, []).append(method)
        return found

    def test_one_method_per_operation(self):
        described = {
            operation["operationId"]: operation
            for path in self.client.openapi()["paths"].values()
            for method, operation in path.items()
            if method in ("get", "put", "post", "delete", "patch")
        }
        self.assertEqual(set(described) - FOR_BROWSERS, set(self.methods()))
        of_the_client = {"cursor", "limit", "if_none_match", "prefer"}
        for identity, methods in self.methods().items():
            asked = {
                parameter["name"].replace("-", "_").lower() for parameter in described[identity].get("parameters", [])
            }
            if "of CSV" in json.dumps(described[identity].get("parameters", [])):
                asked -= {"units"}  # the method reads JSON
            known = set().union(*(inspect.signature(method).parameters for method in methods))
            self.assertLessEqual(asked - of_the_client, known, identity)

    def test_documents_are_described(self):
        made = io.StringIO()
        argv, sys.argv = sys.argv, ["make_documents.py", self.address]
        try:
            with contextlib.redirect_stdout(made):
                load(HERE / "make_documents.py").main()
        finally:
            sys.argv = argv
        names = {}
        exec(compile(made.getvalue(), "documents.py", "exec"), names)  # noqa: S102: written a line above
        self.assertIn("lte", names["LoadCaseResult"].__annotations__)
        for method in itertools.chain(*self.methods().values()):
            for word in re.findall(r"doc\.(\w+)", str(inspect.signature(method).return_annotation)):
                self.assertIn(word, names, method.__name__)

    def test_a_design_is_stored_and_replaced(self):
        stored = self.client.add_design(self.design(), name="mine")
        number = stored.document["id"]
        again = self.client.replace_design(number, self.design(), name="mine too", if_match=stored.tag)
        self.assertEqual(again.document["name"], "mine too")
        with self.assertRaises(Problem) as refused:
            self.client.replace_design(number, self.design(), if_match=stored.tag)
        self.assertEqual(refused.exception.status, 412)
        self.assertIn(number, [design["id"] for design in self.client.designs()])
        self.client.remove_design(number)
        with self.assertRaises(Problem) as gone:
            self.client.design(number)
        self.assertEqual(gone.exception.status, 404)

    def test_a_wrong_key_is_named(self):
        design = self.design()
        design["gear_pair"]["pinion_teeth"] = -17
        with self.assertRaises(Problem) as refused:
            self.client.check(design)
        self.assertEqual(refused.exception.status, 422)
        self.assertIn("/gear_pair/pinion_teeth", [fault["pointer"] for fault in refused.exception.errors])

    def test_from_design_to_search_and_rig(self):
        design = self.design()
        result = self.client.analyze(design)
        self.assertEqual(len(result["load_cases"]), len(design["load_cases"]))
        design["optimization"]["true_evaluations"] = 12
        seen = []
        found = self.client.optimize(design, progress=lambda job: seen.append(job["state"]))
        self.assertEqual(seen[-1], "done")
        self.assertEqual(found["true_evaluations"], 12)
        job = next(self.client.jobs(state="done", kind="optimize"))
        self.assertEqual(len(list(self.client.job_history(job["id"]))), 12)
        stored = self.client.add_design(design).document["id"]
        text = self.client.synthetic_recording({"design": design})
        measurement = self.client.add_measurement(
            ("run.csv", text.encode()), design=stored, torque_Nm=result["load_cases"][0]["torque_Nm"], label="modified"
        )
        self.assertEqual(self.client.measurement_file(measurement["id"]).decode(), text)
        self.assertEqual([row["id"] for row in self.client.measurements(design=stored)], [measurement["id"]])
        compared = self.client.compare_design(stored)
        self.assertTrue(compared)

    def test_events_of_a_job_end_with_it(self):
        job = self.client.add_job({"kind": "prepare", "design": self.design()})
        self.assertIn(list(self.client.follow(job["id"]))[-1]["state"], ("done",))

    def test_a_broken_stream_is_taken_up_again(self):
        client = Client(self.address)
        job = client.add_job({"kind": "prepare", "design": self.design()})
        calls = []

        def broken(identity, last):
            calls.append(last)
            if len(calls) == 1:
                raise ConnectionResetError
            return original(identity, last)

        original, client.job_events = client.job_events, broken
        self.assertEqual(list(client.follow(job["id"]))[-1]["state"], "done")
        self.assertEqual(len(calls), 2)
        self.assertEqual([state["state"] for state in client.follow(job["id"])], ["done"])

    def test_events_as_they_are_written(self):
        stream = io.BytesIO(b": comment\n\nid: 7\nevent: job\ndata: {\"a\":\ndata: 1}\n\ndata: 2\n\n")
        self.assertEqual([(event.id, event.name, event.data) for event in read_events(stream)],
                         [("7", "job", {"a": 1}), ("7", "message", 2)])  # fmt: skip

    def test_a_hostile_file_name_stays_a_name(self):
        kind, body = encode_form({"design": 1, "label": None}, [('a"\r\nX: y.csv', b"1,2\n")])
        self.assertIn(b'filename="a%22%0D%0AX: y.csv"', body)
        self.assertNotIn(b"label", body)
        self.assertIn("boundary=", kind)

    def test_the_example_runs(self):
        path = Path(self.folder.name) / "design.json"
        path.write_text(json.dumps(self.design()), encoding="utf-8")
        done = subprocess.run(
            [sys.executable, str(HERE / "examples" / "quiet_flank.py"), str(path), self.address, "8"],
            cwd=self.folder.name, env={**os.environ, "PYTHONPATH": str(HERE)}, capture_output=True, text=True,
            timeout=120, check=True,
        )  # fmt: skip
        self.assertEqual(done.stdout.count("um peak to peak"), len(self.design()["load_cases"]))
        rows = (Path(self.folder.name) / "transmission_error.csv").read_text().splitlines()
        self.assertEqual(len(rows), 1 + COARSE["positions"])

    def test_the_robust_example_runs(self):
        path = Path(self.folder.name) / "design.json"
        design = self.design()
        design["load_cases"] = design["load_cases"][:1]
        path.write_text(json.dumps(design), encoding="utf-8")
        done = subprocess.run(
            [sys.executable, str(HERE / "examples" / "robust_flank.py"), str(path), self.address, "8", "8"],
            cwd=self.folder.name, env={**os.environ, "PYTHONPATH": str(HERE)}, capture_output=True, text=True,
            timeout=120, check=True,
        )  # fmt: skip
        self.assertEqual(done.stdout.count("of 100 pairs as made below"), 2)
        robust = json.loads((Path(self.folder.name) / "robust.json").read_text())
        self.assertEqual(robust["objective"]["robust"], "percentile")
        self.assertTrue(robust["modification"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
