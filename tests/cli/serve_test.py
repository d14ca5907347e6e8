"""serve: the link it prints, who gets in, what its interface answers, and how it ends."""
import json
import os
import signal
import subprocess
import tempfile
import time
import unittest
import urllib.error
import urllib.request
from pathlib import Path

from command import INTERRUPTED, PROGRAM, CommandTest, parse_json


class Serve(CommandTest):
    def setUp(self):
        super().setUp()
        self.run_command("simulate", "--output", "rig.csv", "--duration", "20", "--seed", "1")

    def start(self, *arguments, environment=None):
        server = subprocess.Popen(
            [PROGRAM, "serve", "--no-browser", *arguments], cwd=self.folder, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True, env={**os.environ, **(environment or {})})
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.stderr.close)
        self.addCleanup(server.wait, 120)
        self.addCleanup(server.kill)
        self.link = server.stdout.readline().strip()
        self.assertRegex(self.link, r"^http://[^/]+:\d+/\?token=[0-9a-f]{32}$")
        self.base, self.token = self.link.split("/?token=")
        return server

    def ask(self, path, method="GET", body=None, **headers):
        headers = {"Authorization": "Bearer " + self.token, **headers}
        request = urllib.request.Request(self.base + path, data=body, method=method, headers=headers)
        try:
            with urllib.request.urlopen(request, timeout=120) as answer:
                return answer.status, answer.read(), answer.headers
        except urllib.error.HTTPError as refused:
            with refused:
                return refused.code, refused.read(), refused.headers

    def get(self, path):
        status, body, _ = self.ask(path)
        self.assertEqual(status, 200, body)
        return parse_json(body.decode())

    def ended(self, number):
        for _ in range(5000):
            state = self.get(f"/api/analyses/{number}")
            if state["state"] not in ("waiting", "running"):
                return state
            time.sleep(0.05)
        self.fail("the analysis does not end")

    def begin(self, **asked):
        status, body, _ = self.ask("/api/analyses", "POST", json.dumps(asked).encode())
        self.assertEqual(status, 201, body)
        return parse_json(body.decode())["id"]

    def view(self, name):
        for _ in range(5000):
            state = self.get("/api/view?file=" + name)
            if state["state"] == "done":
                return state["head"]
            self.assertIsNone(state["error"])
            time.sleep(0.05)
        self.fail("the recording is not opened")

    def test_prints_one_link_and_ends_on_ctrl_c_without_leaving_anything(self):
        with tempfile.TemporaryDirectory() as place:
            server = self.start(environment={"TMPDIR": place})
            self.assertTrue(self.link.startswith("http://127.0.0.1:"))
            self.assertEqual(self.ask("/?token=" + self.token)[0], 200)
            self.assertEqual(len(os.listdir(place)), 1)
            server.send_signal(signal.SIGINT)
            rest, errors = server.communicate(timeout=120)
            self.assertEqual((rest, errors, server.returncode), ("", "", INTERRUPTED))
            self.assertEqual(os.listdir(place), [])
        self.assertEqual(self.leftovers(), [])

    def test_ends_while_an_analysis_runs(self):
        server = self.start()
        self.begin(verb="wheel", files=["rig.csv"], options={"radius": 0.1})
        server.send_signal(signal.SIGTERM)
        server.communicate(timeout=120)
        self.assertEqual(server.returncode, INTERRUPTED)

    def test_two_runs_have_two_tokens(self):
        self.start()
        first = self.token
        self.start()
        self.assertNotEqual(first, self.token)

    def test_nobody_else_gets_in(self):
        self.start()
        port = self.base.rsplit(":", 1)[1]
        self.assertEqual(self.ask("/api/info", Authorization="")[0], 403)
        self.assertEqual(self.ask("/api/info", Host="evil.example:" + port)[0], 421)
        self.assertEqual(self.ask("/api/info", Origin="http://evil.example")[0], 403)
        self.assertEqual(self.ask("/api/info?token=" + "0" * 32, Authorization="")[0], 403)
        status, body, headers = self.ask("/", Authorization="")
        self.assertEqual(status, 403)
        self.assertNotIn(b"rig.csv", body)
        self.assertNotIn(self.folder.name.encode(), body)
        self.assertNotIn("unsafe-inline", headers["Content-Security-Policy"])
        self.assertEqual(headers["X-Content-Type-Options"], "nosniff")
        self.assertIsNone(headers["Access-Control-Allow-Origin"])

    def test_no_path_leads_out_of_the_folder(self):
        (self.folder / "served").mkdir()
        (self.folder / "served" / "link.csv").symlink_to(self.folder / "rig.csv")
        (self.folder / "served" / "out").symlink_to("/etc")
        self.start("served")
        for name in ("../rig.csv", "link.csv", "out/passwd", "/etc/passwd", "..%2Frig.csv"):
            for route in ("/api/view?file=", "/api/recording?file="):
                self.assertEqual(self.ask(route + name)[0], 404, name)
        self.assertEqual(self.get("/api/recordings")["recordings"], [])

    def test_any_other_address_comes_with_a_warning(self):
        server = self.start("--listen", "127.0.0.2")
        self.assertEqual(self.ask("/api/info")[0], 200)
        server.send_signal(signal.SIGINT)
        self.assertEqual(server.communicate(timeout=120)[1], "")
        server = self.start("--listen", "0.0.0.0")
        server.send_signal(signal.SIGINT)
        self.assertIn("nothing is encrypted", server.communicate(timeout=120)[1])

    def test_says_why_it_cannot_begin(self):
        self.start()
        port = self.base.rsplit(":", 1)[1]
        self.assertIn("cannot be listened on", self.expect_failure(4, "serve", "--port", port))
        self.assertIn("none", self.expect_failure(3, "serve", "none"))
        self.expect_failure(2, "serve", "--listen", "nowhere.example")
        self.expect_failure(2, "serve", "--port", "70000")

    def test_lists_what_inspect_says(self):
        self.write("bad.csv", b"no,table\n")
        self.start()
        for _ in range(5000):
            listed = self.get("/api/recordings")
            if listed["left"] == 0:
                break
            time.sleep(0.05)
        by_name = {one["name"]: one for one in listed["recordings"]}
        self.assertEqual(set(by_name), {"bad.csv", "rig.csv", "rig.truth.csv"})
        self.assertIn("no row of numbers", by_name["bad.csv"]["error"])
        summary = by_name["rig.csv"]["summary"]
        self.assertEqual((summary["samples"], summary["rate_hz"], len(summary["channels"])), (4000, 200, 6))
        self.assertEqual(len(summary["thumbnails"]), 3)
        details = self.get("/api/recording?file=rig.csv")
        self.assertEqual(details["json"]["samples"], 4000)
        self.assertEqual(details["page"]["verb"], "inspect")

    def test_a_window_has_the_samples_of_the_file(self):
        self.start()
        head = self.view("rig.csv")
        self.assertEqual(head["samples"], 4000)
        lines = (self.folder / "rig.csv").read_text().splitlines()
        first = next(k for k, line in enumerate(lines) if line.startswith("t")) + 1
        rows = [[float(cell) for cell in line.split(",")] for line in lines[first:]]
        window = self.get("/api/view/window?file=rig.csv&from=5&to=5.1&pixels=500")
        self.assertTrue(window["samples"])
        for at, value in zip(window["t"], window["min"][0]):
            self.assertAlmostEqual(value, rows[round(at * 200)][1], places=6)
        coarse = self.get("/api/view/window?file=rig.csv&from=0&to=20&pixels=100")
        self.assertFalse(coarse["samples"])
        self.assertAlmostEqual(max(coarse["max"][0]), max(row[1] for row in rows), places=6)
        between = self.get("/api/view/figures?file=rig.csv&from=1&to=2")["channels"][0]
        inside = [row[1] for row in rows[200:401]]
        self.assertEqual(between["count"], len(inside))
        self.assertAlmostEqual(between["mean"], sum(inside) / len(inside), places=6)
        noise = self.get("/api/view/noise?file=rig.csv&from=0&to=19&channel=2")
        self.assertEqual(noise["verb"], "noise")

    def test_an_analysis_is_that_of_the_command(self):
        self.start()
        number = self.begin(verb="wheel", files=["rig.csv"], options={"radius": 0.1, "to": 10})
        state = self.ended(number)
        self.assertEqual(state["state"], "done", state)
        self.assertEqual(state["files_made"], ["result.json", "page.json", "report.html", "series.csv"])
        result = self.get(f"/api/analyses/{number}/result.json")
        self.check_document("wheel", result)
        self.succeed("wheel", "rig.csv", "--radius", "0.1", "--to", "10", "--json", "own.json")
        own = parse_json((self.folder / "own.json").read_text())
        for document in (result, own):
            del document["provenance"]
        self.assertEqual(result, own)
        page = self.get(f"/api/analyses/{number}/page.json")
        report = self.ask(f"/api/analyses/{number}/report.html")[1].decode()
        self.assertIn(page["conclusion"][:20], report)
        figures = sum(len(section["figures"]) for section in page["sections"])
        self.assertEqual(figures, report.count("<svg"))

    def test_sensor_files_are_shown_compared_and_exported(self):
        for name, seed in (("old", "1"), ("new", "2")):
            self.succeed("simulate", "--procedure", "multi-position", "--output", name + ".csv", "--seed", seed)
            self.succeed("calibrate", name + ".csv", "--update-sensor", name + ".toml")
        self.start()
        self.assertLessEqual({"new.toml", "old.toml"}, set(self.get("/api/recordings")["sensor_files"]))
        shown = self.begin(verb="sensor show", files=["old.toml"])
        self.assertEqual(self.ended(shown)["state"], "done", self.ended(shown))
        self.assertEqual(self.get(f"/api/analyses/{shown}/result.json")["action"], "show")
        compared = self.begin(verb="sensor diff", files=["old.toml", "new.toml"])
        self.assertEqual(self.ended(compared)["state"], "done", self.ended(compared))
        self.assertIn("bias", json.dumps(self.get(f"/api/analyses/{compared}/page.json")))
        exported = self.begin(verb="sensor export", files=["old.toml"], options={"format": "c-header"})
        state = self.ended(exported)
        self.assertEqual((state["state"], state["files_made"]), ("done", ["result.json"]), state)
        self.assertIn("#define", self.get(f"/api/analyses/{exported}/result.json")["text"])
        self.assertEqual(self.ask("/api/analyses", "POST", json.dumps({"verb": "sensor show", "files": ["old.toml"], "options": {"format": "c-header"}}).encode())[0], 400)

    def test_an_analysis_that_fails_says_what_the_command_says(self):
        self.start()
        state = self.ended(self.begin(verb="noise", files=["rig.csv"], options={"from": 5, "to": 4}))
        said = self.run_command("noise", "rig.csv", "--from", "5", "--to", "4").stderr.decode()
        self.assertEqual("proofmass: " + state["error"], said.strip())

    def test_forms_are_the_flags(self):
        self.start()
        verbs = {verb["name"]: verb for verb in self.get("/api/verbs")["verbs"]}
        self.assertLessEqual({"inspect", "noise", "wheel", "track", "tilt", "tune", "calibrate", "tumble"}, set(verbs))
        self.assertNotIn("drive", verbs, "it has no list of recordings")
        options = {option["name"]: option for option in verbs["noise"]["options"]}
        self.assertEqual(options["statistic"]["default"], "oadev")
        self.assertIn("theo1", options["statistic"]["choices"])
        self.assertTrue(options["exclude-events"]["switch"])
        self.assertTrue(options["channel"]["many"] and options["sensor"]["file"])
        self.assertFalse({"json", "report", "output", "page", "config", "update-sensor"} & set(options))
        help_text = self.succeed("noise", "--help") + self.succeed("noise", "--help-input")
        for name in options:
            self.assertIn("--" + name, help_text)

    def test_an_added_file_never_replaces_another(self):
        self.start()
        before = (self.folder / "rig.csv").read_bytes()
        status, body, _ = self.ask("/api/files/rig.csv", "PUT", b"x\n1\n")
        self.assertEqual((status, parse_json(body.decode())["name"]), (201, "rig-2.csv"))
        self.assertEqual((self.folder / "rig.csv").read_bytes(), before)
        self.assertEqual((self.folder / "rig-2.csv").read_bytes(), b"x\n1\n")
        self.assertEqual(self.ask("/api/files/..%2Fx.csv", "PUT", b"1")[0], 400)
        self.assertEqual([path.name for path in self.folder.iterdir() if path.name.startswith(".")], [])

    def test_of_one_file_serves_nothing_else(self):
        self.start("rig.csv")
        self.assertEqual(self.get("/api/info")["only"], "rig.csv")
        self.assertEqual(self.ask("/api/view?file=rig.truth.csv")[0], 404)
        self.assertEqual([one["name"] for one in self.get("/api/recordings")["recordings"]], ["rig.csv"])

    def test_of_a_source_watches_it_and_records_nothing(self):
        self.start("sim:wheel?rate=200", "--estimate", "wheel")
        number = self.get("/api/info")["source"]
        for _ in range(1000):
            source = self.get(f"/api/live/{number}")
            if source["last_state"] is not None and source["last_state"]["samples"] > 0:
                break
            time.sleep(0.05)
        self.assertEqual((source["state"], source["file"]), ("running", None))
        self.assertEqual(source["options"], {"estimate": "wheel"})
        self.assertEqual([one["name"] for one in self.get("/api/recordings")["recordings"]], ["rig.csv", "rig.truth.csv"])

    def test_of_a_source_that_cannot_be(self):
        self.assertIn("FOLDER", self.expect_failure(2, "serve", "rig.csv", "--estimate", "wheel"))
        self.expect_failure(2, "serve", "stdin:")
        self.expect_failure(2, "serve", "replay:../x.csv")


if __name__ == "__main__":
    unittest.main()
