"""Clients that are not ours are understood: `buf curl`, with the schema of the repository, by reflection, over gRPC-web;
and with the published schema of gRPC's health checks."""

import json
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import phrenic
from support import REPOSITORY, SessionTest

BUF = shutil.which("buf", path=str(REPOSITORY / "web" / "node_modules" / ".bin")) or shutil.which("buf")
SCHEMA = ["--schema", str(REPOSITORY / "proto")]
GRPC = ["--protocol", "grpc", "--http2-prior-knowledge"]

# grpc/health/v1/health.proto of https://github.com/grpc/grpc-proto, as far as Check needs it.
HEALTH = """
syntax = "proto3";
package grpc.health.v1;
message HealthCheckRequest { string service = 1; }
message HealthCheckResponse {
  enum ServingStatus { UNKNOWN = 0; SERVING = 1; NOT_SERVING = 2; SERVICE_UNKNOWN = 3; }
  ServingStatus status = 1;
}
service Health { rpc Check(HealthCheckRequest) returns (HealthCheckResponse); }
"""


@unittest.skipUnless(BUF, "there is no buf: run npm ci in web")
class BufCurlTest(SessionTest):
    def curl(self, path, *words, data=None, address=None):
        address = address or f"http://{phrenic.default_server().address}"
        body = [] if data is None else ["--data", json.dumps(data)]
        command = [BUF, "curl", *words, *body, f"{address}/{path}"]
        return subprocess.run(command, capture_output=True, text=True, timeout=60)

    def answer(self, path, *words, **options):
        done = self.curl(path, *words, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def test_the_list_of_sessions_is_read_by_the_schema_and_by_reflection(self):
        session = self.session(set={"breath_force": 1.5})
        session.step(3, read=())
        for schema in (SCHEMA, []):
            listed = self.answer("phrenic.v1.SessionService/ListSessions", *GRPC, *schema)["sessions"]
            (found,) = [each for each in listed if each["id"] == session.id]
            self.assertEqual((found["scene"], found["tick"]), ("cube-springs", "3"))
            self.assertEqual(found["parameters"]["breathForce"], 1.5)

    def test_a_session_is_made_stepped_and_deleted(self):
        made = self.answer("phrenic.v1.SessionService/CreateSession", *GRPC, *SCHEMA, data={"source": {"name": "cube-springs"}})
        id = made["session"]["id"]
        stepped = self.answer("phrenic.v1.SessionService/StepSession", *GRPC, *SCHEMA, data={"session_id": id, "ticks": 20})
        self.assertEqual(stepped["stateHash"], self.session().step(20, read=()).state_hash)
        self.answer("phrenic.v1.SessionService/DeleteSession", *GRPC, *SCHEMA, data={"session_id": id})
        self.assertNotIn(id, phrenic.default_server().sessions())

    def test_errors_have_their_code_and_their_text(self):
        web = f"http://127.0.0.1:{phrenic.default_server().about.web_port}"
        for words, address in ((GRPC, None), (["--protocol", "grpcweb"], web)):
            done = self.curl("phrenic.v1.SessionService/GetSession", *words, *SCHEMA, data={"session_id": "none"}, address=address)
            self.assertNotEqual(done.returncode, 0)
            error = json.loads(done.stderr)
            self.assertEqual(error["code"], "not_found")
            self.assertIn('there is no session "none"', error["message"])

    def test_a_stream_ends_with_its_result(self):
        request = {"source": {"name": "cube-springs"}, "runs": [{}, {}], "seconds": 0.1, "finished": [1]}
        done = self.curl("phrenic.v1.StudyService/RunBatch", *GRPC, *SCHEMA, data=request)
        self.assertEqual(done.returncode, 0, done.stderr)
        decoder, text, messages = json.JSONDecoder(), done.stdout.strip(), []
        while text:
            message, end = decoder.raw_decode(text)
            messages.append(message)
            text = text[end:].strip()
        self.assertIn("header", messages[0])
        self.assertEqual([message["result"].get("run", 0) for message in messages[1:]], [0])

    def test_grpcs_health_check_is_answered(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "grpc", "health", "v1", "health.proto")
            path.parent.mkdir(parents=True)
            path.write_text(HEALTH)
            answer = self.answer("grpc.health.v1.Health/Check", *GRPC, "--schema", folder, data={})
        self.assertEqual(answer, {"status": "SERVING"})
