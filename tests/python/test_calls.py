"""What goes over the wire: metadata, repeats, errors. The server is a fake whose answers the test chooses."""

import contextlib
import subprocess
import sys
import time
import unittest

import grpc

import phrenic
from phrenic import call, errors, jobs
from phrenic.connection import Channel, target_of
from phrenic.operations import create
from phrenic.v1 import session_pb2, state_pb2
from support import FakeServer, failing

UNAVAILABLE = grpc.StatusCode.UNAVAILABLE


class CallsTest(unittest.TestCase):
    def setUp(self):
        self.fake = FakeServer()
        self.addCleanup(self.fake.stop)
        self.server = phrenic.connect(self.fake.address, token="secret", retries=3)
        self.addCleanup(self.server.close)

    def step_at(self, tick):
        """Answers StepSession as a session at `tick` would."""

        def answer(request):
            return session_pb2.StepSessionResponse(session={"id": "fake", "tick": tick + request.ticks})

        return answer

    def test_calls_name_their_session_and_the_account(self):
        session = self.server.attach("class")
        session.step(1, read=())
        for _, _, metadata in self.fake.calls[1:]:
            self.assertEqual(metadata["x-session-id"], "class")
        for _, _, metadata in self.fake.calls:
            self.assertEqual(metadata["authorization"], "Bearer secret")

    def test_a_change_is_repeated_with_one_request_id(self):
        then = session_pb2.UpdateParametersResponse(session={"id": "fake"})
        self.fake.answers["UpdateParameters"] = failing(UNAVAILABLE, 2, then)
        phrenic.Session("any", server=self.server).set(breath_force=2)
        ids = {request.request_id for request in self.fake.made("UpdateParameters")}
        self.assertEqual((len(self.fake.made("UpdateParameters")), len(ids)), (3, 1))
        self.assertTrue(all(ids))

    def test_a_session_is_made_once_however_often_the_call_is_repeated(self):
        exists, missing = grpc.StatusCode.ALREADY_EXISTS, grpc.StatusCode.NOT_FOUND
        made = lambda request: session_pb2.GetSessionResponse(session={"id": request.session_id, "tick": 5})  # noqa: E731

        def create(request, context):  # the first answer is lost, and the session is there
            context.abort(UNAVAILABLE if len(self.fake.made("CreateSession")) == 1 else exists, "")

        self.fake.answers["CreateSession"] = create
        self.fake.answers["GetSession"] = lambda request, context: (
            made(request) if len(self.fake.made("GetSession")) > 1 else context.abort(missing, "it is being compiled")
        )
        session = phrenic.Session("any", server=self.server)
        ids = [request.session_id for request in self.fake.made("CreateSession")]
        self.assertEqual(ids, [session.id] * 2)
        self.assertRegex(session.id, "^any-[0-9a-f]{12}$")
        self.assertEqual(session.tick, 5)
        with self.assertRaises(errors.AlreadyExists):  # which of the callers made it is not known
            phrenic.Session("any", id="mine", server=self.server)

    def test_a_session_whose_creation_was_cut_off_is_deleted(self):
        operation = create("any", None, "", "", None, None)
        made = next(operation)
        deleted = operation.throw(KeyboardInterrupt())
        self.assertEqual(deleted.method, "SessionService.DeleteSession")
        self.assertEqual(deleted.request.session_id, made.request.session_id)
        with self.assertRaises(KeyboardInterrupt):
            operation.throw(errors.NotFound("it was not made"))

    def test_a_fork_is_made_once_however_often_the_call_is_repeated(self):
        session = phrenic.Session("any", server=self.server)
        then = session_pb2.ForkSessionResponse(session={"id": "x"}, control_token="key")
        self.fake.answers["ForkSession"] = failing(UNAVAILABLE, 2, then)
        session.fork()
        ids = [request.fork_id for request in self.fake.made("ForkSession")]
        self.assertEqual(ids, ids[:1] * 3)
        self.assertTrue(ids[0])

    def test_a_job_is_begun_once_however_often_the_call_is_repeated(self):
        ids = []

        def answer(sent):  # the server has begun it, and the first answer is lost
            ids.append(sent.request.study_id)
            raise errors.Unavailable("") if len(ids) == 1 else errors.AlreadyExists("")

        operation = jobs.study("cost", session_pb2.SceneSource(), None, {}, None)
        sent = next(operation)
        self.assertTrue(sent.repeatable)
        for _ in range(2):
            try:
                answer(sent)
            except errors.Error as error:
                failed = error
        watch = operation.throw(failed)
        self.assertEqual(watch.method, "StudyService.WatchStudy")
        self.assertEqual([watch.request.study_id] * 2, ids)
        deleted = operation.throw(errors.Unavailable("lost"))
        self.assertEqual((deleted.method, deleted.repeats), ("StudyService.DeleteStudy", call.FIRST))
        with self.assertRaisesRegex(errors.Unavailable, "lost"):
            operation.throw(errors.NotFound("a restarted server has no such study"))

    def test_a_fork_that_cannot_be_changed_is_deleted(self):
        session = phrenic.Session("any", server=self.server)
        self.fake.answers["UpdateParameters"] = failing(grpc.StatusCode.INVALID_ARGUMENT, 1, None)
        with self.assertRaises(errors.InvalidArgument):
            session.fork(id="branch", breath_force=99)
        self.assertEqual([r.session_id for r in self.fake.made("DeleteSession")], ["branch"])
        with self.assertRaisesRegex(errors.InvalidArgument, "no parameter bad"):
            session.fork(id="other", bad=1)
        self.assertEqual([r.session_id for r in self.fake.made("DeleteSession")], ["branch", "other"])

    def test_all_calls_are_repeated_for_about_a_minute_but_the_first_for_seconds(self):
        lost, change = errors.Unavailable(""), call.Call("any", session_pb2.GetSessionRequest())
        first = call.Call("any", session_pb2.GetSessionRequest(), repeats=call.FIRST)
        for each, least, most in ((change, 35, 85), (first, 0.5, 3)):
            waits, attempt = [], 0
            told = self.assertLogs("phrenic", "WARNING") if each is change else contextlib.nullcontext()
            with told:
                while (wait := call.delay_before_repeat(each, lost, attempt, call.RETRIES)) is not None:
                    waits.append(wait)
                    attempt += 1
            self.assertTrue(least < sum(waits) < most, sum(waits))
        for defaults in (phrenic.connect.__kwdefaults__, phrenic.aio.connect.__kwdefaults__):
            self.assertEqual(defaults["retries"], call.RETRIES)

    def test_steps_after_a_deadline_begin_where_the_server_was_stopped(self):
        session = phrenic.Session("any", server=self.server)
        self.fake.answers["StepSession"] = lambda *_: time.sleep(0.5)
        with self.assertRaises(errors.DeadlineExceeded):
            session.step(100, read=(), timeout=0.1)
        self.fake.answers["StepSession"] = lambda request, _: self.step_at(request.expected_tick)(request)
        paused = session_pb2.PauseSessionResponse(session={"id": "fake", "tick": 37})
        self.fake.answers["PauseSession"] = lambda *_: paused
        self.assertEqual(session.step(1, read=()).tick, 38)
        self.assertEqual([r.expected_tick for r in self.fake.made("StepSession")], [0, 37])

    def test_other_errors_are_not_repeated(self):
        self.fake.answers["UpdateParameters"] = failing(grpc.StatusCode.ABORTED, 9, None)
        with self.assertRaises(errors.Aborted):
            phrenic.Session("any", server=self.server).set(breath_force=2)
        self.assertEqual(len(self.fake.made("UpdateParameters")), 1)

    def test_steps_whose_answer_was_lost_are_not_taken_twice(self):
        session = phrenic.Session("any", server=self.server)
        self.fake.answers["StepSession"] = failing(UNAVAILABLE, 1, None)
        done = session_pb2.GetStateResponse(state={"tick": 4}, state_hash="a")
        self.fake.answers["GetState"] = failing(UNAVAILABLE, 1, done)
        self.assertEqual(session.step(4, read=()).state_hash, "a")
        self.assertEqual(len(self.fake.made("StepSession")), 1)

    def test_steps_that_were_cut_off_are_taken_to_their_end(self):
        session = phrenic.Session("any", server=self.server)
        self.fake.answers["StepSession"] = failing(UNAVAILABLE, 1, self.step_at(3))
        self.fake.answers["GetState"] = lambda *_: session_pb2.GetStateResponse(state={"tick": 3})
        self.assertEqual(session.step(10, read=()).tick, 10)
        self.assertEqual([(r.ticks, r.expected_tick) for r in self.fake.made("StepSession")], [(10, 0), (7, 3)])

    def test_steps_are_repeated_once(self):
        session = phrenic.Session("any", server=self.server)
        self.fake.answers["StepSession"] = failing(UNAVAILABLE, 99, self.step_at(0))
        with self.assertRaises(errors.Unavailable):
            session.step(10, read=())
        self.assertEqual(len(self.fake.made("StepSession")), 2)

    def test_steps_of_a_session_that_others_step_are_not_repeated(self):
        session = self.server.attach("class")
        self.fake.answers["StepSession"] = failing(UNAVAILABLE, 9, None)
        with self.assertRaises(errors.Unavailable):
            session.step(1, read=())
        request = self.fake.made("StepSession")[0]
        self.assertFalse(request.HasField("expected_tick"))

    def test_a_deadline_ends_a_call(self):
        session = phrenic.Session("any", server=self.server)
        self.fake.answers["StepSession"] = lambda *_: time.sleep(1)
        with self.assertRaisesRegex(errors.DeadlineExceeded, "timeout="):
            session.step(1, read=(), timeout=0.1)

    def test_every_status_code_has_its_class(self):
        for code in grpc.StatusCode:
            if code != grpc.StatusCode.OK:
                self.assertEqual(errors.make_error(code.name, "text").code, code.name)

    def test_an_error_whose_remedy_depends_on_the_call_has_the_text_of_the_server_alone(self):
        for code in ("FAILED_PRECONDITION", "RESOURCE_EXHAUSTED"):
            self.assertEqual(str(errors.make_error(code, "the export is not done: wait for it")),
                             "the export is not done: wait for it")  # fmt: skip

    def test_what_is_constant_is_read_for_the_parts_that_need_it(self):
        session = phrenic.Session("any", server=self.server)
        for parts in (("positions",), ("velocities", "scalars")):
            session.step(1, read=parts)  # this server has no GetGeometry
        self.assertEqual([list(r.read) for r in self.fake.made("GetState")], [[state_pb2.STATE_PART_LAYOUT]])

    def test_both_clients_open_their_channel_alike(self):
        for each in (phrenic.connection.Connection, phrenic.aio.Connection):
            self.assertTrue(issubclass(each, Channel))
            self.assertIs(each.open, Channel.open)

    def test_a_token_does_not_cross_a_network_in_the_clear(self):
        with self.assertRaisesRegex(errors.InvalidArgument, "https://example.org:1"):
            target_of("example.org:1", token="secret")
        self.assertIsNotNone(target_of("https://example.org:1", token="secret").tls)
        self.assertIsNone(target_of("[::1]:1", token="secret").tls)
        for bad in ("example.org", "ftp://a:1", ""):
            with self.assertRaisesRegex(errors.InvalidArgument, "HOST:PORT"):
                target_of(bad)

    def test_a_missing_certificate_is_named(self):
        with self.assertRaisesRegex(errors.InvalidArgument, "tls: /no/ca.pem"):
            phrenic.connect("https://127.0.0.1:1", tls="/no/ca.pem")


CHILD = """
import sys, time, phrenic
server = phrenic.connect(sys.argv[1], retries=0)
time.sleep(float(sys.argv[2]))
server.sessions()
"""


class IdleTest(unittest.TestCase):
    def test_an_idle_connection_answers_the_servers_pings(self):
        pings = {"grpc.keepalive_time_ms": 1000, "grpc.keepalive_timeout_ms": 3000, "grpc.keepalive_permit_without_calls": 1,
                 "grpc.http2.max_pings_without_data": 0}  # fmt: skip
        fake = FakeServer(**pings)
        self.addCleanup(fake.stop)
        # What has not answered is closed after 4 s, and a call just then is lost. Processes of their own, as any thread
        # that waits in gRPC reads for all connections of its process.
        words = [sys.executable, "-c", CHILD, fake.address]
        idle = [subprocess.Popen([*words, str(t)], stderr=subprocess.PIPE, text=True) for t in (4.15, 4.35, 4.55, 4.75)]
        said = [child.communicate(timeout=60)[1] for child in idle]
        self.assertEqual([child.returncode for child in idle], [0] * len(idle), said)
