"""A batch gives what a loop of sessions gives, at any number of threads."""

import itertools

import phrenic
from support import Relay, SessionTest

FORCES = [{"breath_force": force} for force in (0.5, 1, 1.5, 2, 2.5)]


class BatchTest(SessionTest):
    def hashes(self, threads):
        runs = phrenic.batch("pressure-lungs", FORCES, seconds=0.3, fps=10, threads=threads)
        return {run.index: run.state_hash for run in runs}

    def test_threads_change_no_bit(self):
        expected = {}
        for index, values in enumerate(FORCES):
            session = self.session("pressure-lungs", set=values)
            expected[index] = [frame.state_hash for frame in session.play(0.3, fps=10)][-1]
        self.assertEqual(self.hashes(1), expected)
        self.assertEqual(self.hashes(3), expected)
        self.assertEqual(len(set(expected.values())), len(FORCES))

    def test_a_summary_is_the_range_of_the_samples(self):
        (run,) = phrenic.batch("pressure-lungs", [{}], seconds=0.5, fps=1000)
        (short,) = phrenic.batch("pressure-lungs", [{}], seconds=0.5, fps=1000, summary=True)
        self.assertEqual((short.state_hash, len(short.times)), (run.state_hash, 0))
        for name, values in run.measures.items():
            self.assertEqual(short.summary.last[name], values[-1])
            self.assertEqual((short.summary.least[name], short.summary.greatest[name]), (values.min(), values.max()))

    def relayed(self, retries):
        """A connection by a relay, and the `finished` of each request that goes over it."""
        relay = Relay(phrenic.default_server().address)
        self.addCleanup(relay.stop)
        server = phrenic.connect(relay.address, retries=retries)
        self.addCleanup(server.close)
        asked, stream = [], server.connection.stream

        def noted(call):
            asked.append(set(call.request.finished))
            return stream(call)

        server.connection.stream = noted
        return relay, server, asked

    def test_a_lost_connection_costs_no_run(self):
        forces = [{"breath_force": 0.1 * i} for i in range(20)]
        expected = {run.index: run.state_hash for run in phrenic.batch("pressure-lungs", forces, seconds=1, fps=1)}
        relay, server, asked = self.relayed(retries=5)
        seen = []
        for run in phrenic.batch("pressure-lungs", forces, seconds=1, fps=1, server=server):
            seen.append((run.index, run.state_hash))
            if len(seen) in (3, 9):
                relay.cut()
        self.assertEqual(len(seen), len(forces), "a run came twice or not at all")
        self.assertEqual(dict(seen), expected)
        self.assertEqual(asked[0], set())
        # Once or twice: what comes after the second cut may have arrived before it.
        self.assertIn(len(asked), (2, 3))
        for before, after in zip(asked, asked[1:]):
            self.assertLess(before, after)
        self.assertLessEqual({index for index, _ in seen[:3]}, asked[1])

    def test_a_connection_that_stays_lost_is_an_error(self):
        relay, server, asked = self.relayed(retries=1)
        runs = phrenic.batch("pressure-lungs", [{}] * 20, seconds=1, fps=1, server=server)
        next(runs)
        relay.stop()
        with self.assertRaises(phrenic.errors.Unavailable):
            list(runs)
        self.assertEqual(len(asked), 2)

    def test_a_batch_that_was_left_is_finished_by_another_call(self):
        runs = phrenic.batch("cube-springs", FORCES, seconds=0.2, fps=10)
        first = {run.index: run.state_hash for run in itertools.islice(runs, 2)}
        runs.close()
        rest = phrenic.batch("cube-springs", FORCES, seconds=0.2, fps=10, finished=first)
        rest = {run.index: run.state_hash for run in rest}
        self.assertEqual(set(first) & set(rest), set())
        whole = phrenic.batch("cube-springs", FORCES, seconds=0.2, fps=10)
        self.assertEqual({**first, **rest}, {run.index: run.state_hash for run in whole})
        self.assertEqual(list(phrenic.batch("cube-springs", FORCES, seconds=0.2, finished=range(5))), [])

    def test_parameters_may_be_endless_and_a_loop_may_break(self):
        begun = []

        def endless():
            for force in itertools.count():
                begun.append(force)
                yield {"breath_force": force % 5}

        runs = phrenic.batch("cube-springs", endless(), seconds=0.05, threads=2)
        indices = {next(runs).index for _ in range(300)}
        runs.close()
        self.assertEqual(len(indices), 300)
        self.assertEqual(len(begun), 512)

    def test_runs_go_on_from_a_frame_as_the_session_does(self):
        session = self.session("pressure-lungs")
        frame = session.step(50)
        *_, last = session.play(0.2, fps=10, read=("positions",))
        (run,) = phrenic.batch("pressure-lungs", [{}], seconds=0.2, fps=10, start=frame, read=("positions",))
        self.assertEqual(run.state_hash, last.state_hash)
        self.assertTrue((run.state.positions == last.state.positions).all())
        self.assertEqual(run.times[-1], last.time)
        self.assertEqual({k: v[-1] for k, v in run.measures.items()}, dict(last.measures))
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, r"runs\[0\]\.start\.positions: has \d+ bytes"):
            list(phrenic.batch("cube-springs", [{}], seconds=0.1, start=frame))

    def test_a_run_that_diverges_says_so_and_the_others_go_on(self):
        bad = {"integrator": "explicit_euler", "time_step": 0.1, "elasticity": 10}
        runs = sorted(phrenic.batch("cube-springs", [{}, bad, {}], seconds=60, fps=1), key=lambda run: run.index)
        self.assertRegex(runs[1].diverged, "diverged at [0-9.]+ s at vertex")
        self.assertLess(len(runs[1].times), 60)
        self.assertEqual(runs[0].state_hash, runs[2].state_hash)
        self.assertEqual((len(runs[0].times), runs[0].diverged), (60, ""))

    def test_a_run_that_diverges_before_its_first_sample_has_none(self):
        bad = {"integrator": "explicit_euler", "time_step": 0.1}
        runs = list(phrenic.batch("pressure-lungs", [{}, bad], seconds=3, fps=0.3))
        self.assertEqual(len(runs), 2)
        (run,) = [run for run in runs if run.index == 1]
        self.assertNotEqual(run.diverged, "")
        self.assertEqual({values.shape for values in run.measures.values()}, {run.times.shape})

    def test_many_large_starts_are_sent_in_several_requests(self):
        session = self.session("thorax-thesis", resolution_mm=16)
        frame = session.step(1)
        count = 12_000_000 // frame.state.positions.nbytes
        runs = list(phrenic.batch("thorax-thesis", [{}] * count, seconds=1e-6, start=frame, resolution_mm=16))
        self.assertEqual(sorted(run.index for run in runs), list(range(count)))
        self.assertEqual(len({run.state_hash for run in runs}), 1)

    def test_wrong_arguments_are_refused_by_name(self):
        state = self.session("cube-springs").step(1).state
        for words, arguments in (
            ("starts: runs\\[2\\] has none", {"starts": [state, state]}),
            ("start: give it or starts", {"start": state, "starts": [state] * 3}),
            ("read: give names in a tuple", {"read": "positions"}),
        ):
            with self.assertRaisesRegex(phrenic.errors.InvalidArgument, words):
                list(phrenic.batch("cube-springs", [{}] * 3, seconds=0.1, **arguments))
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "a list of sets"):
            list(phrenic.batch("cube-springs", {"breath_force": 1}, seconds=0.1))
        many = [{"breath_force": 1}] * 299 + [{"breath_force": -1}]
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, r"runs\[299\]"):
            list(phrenic.batch("cube-springs", many, seconds=0.01))

    def test_an_unknown_parameter_ends_the_batch(self):
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "breath_force"):
            list(phrenic.batch("cube-springs", [{"breath_forse": 1}], seconds=0.1))
