"""A process that is forked from one that uses phrenic, and servers that are restarted."""

import os
import signal
import subprocess
import sys
import unittest

import phrenic
from test_local import await_end, lives

BEFORE = """
import os, sys, phrenic
from multiprocessing import get_context
def run(ticks):
    with phrenic.Session("cube-springs") as s:
        return s.step(ticks).tick
"""

EXIT = """
server, own = phrenic.default_server(), phrenic.local()
s = phrenic.Session("cube-springs")
frames, steps = s.watch(), s.advance()
next(frames)
pid = os.fork()
if pid == 0:
    if sys.argv[1] == "use":
        for call in (lambda: s.step(1), lambda: run(1), server.sessions):
            try:
                call()
                os._exit(1)
            except phrenic.errors.FailedPrecondition as error:
                assert "spawn" in str(error), error
    elif sys.argv[1] == "close":
        s.close(), own.close(), server.close()
    sys.exit(0)
print(os.waitpid(pid, 0)[1], steps.step(1).tick, s.step(2).tick, len(own.sessions()), own.process.log.is_file(), server.process.log.is_file())
"""

POOL = """
with get_context("fork").Pool(2) as pool:
    print(*pool.map(run, range(1, 4)))
"""


class ForkTest(unittest.TestCase):
    def said(self, script, *words):
        child = subprocess.run([sys.executable, "-c", BEFORE + script, *words], capture_output=True, text=True, timeout=60)
        self.assertEqual(child.returncode, 0, child.stderr)
        return child.stdout.strip()

    def test_the_end_of_a_forked_child_leaves_the_parents_server(self):
        self.assertEqual(self.said(EXIT, "exit"), "0 1 3 0 True True")

    def test_a_forked_child_that_closes_what_is_its_parents_does_not_end_it(self):
        self.assertEqual(self.said(EXIT, "close"), "0 1 3 0 True True")

    def test_a_forked_child_of_a_process_that_has_called_a_server_is_told_what_to_do(self):
        self.assertEqual(self.said(EXIT, "use"), "0 1 3 0 True True")

    def test_a_pool_that_is_forked_before_the_first_call_has_servers_of_its_own(self):
        self.assertEqual(self.said(POOL), "1 2 3")


class DefaultServerTest(unittest.TestCase):
    def test_a_default_server_that_has_ended_is_started_again(self):
        first = phrenic.default_server()
        self.assertIs(phrenic.default_server(), first)
        os.kill(first.process.pid, signal.SIGKILL)
        self.assertTrue(await_end(first.process.pid))
        with phrenic.Session("cube-springs") as s:
            self.assertEqual(s.step(2).tick, 2)
        second = phrenic.default_server()
        self.assertNotEqual(first.process.pid, second.process.pid)
        second.close()
        self.assertFalse(lives(second.process.pid))
        with phrenic.Session("cube-springs") as s:
            self.assertEqual(s.step(3).tick, 3)

    def test_a_server_that_does_not_start_does_not_advise_to_start_it_so(self):
        for flags, word in ((["--nonsense"], "--nonsense"), (["--step-threads", "x"], "--step-threads: Value x")):
            with self.assertRaisesRegex(phrenic.errors.NotStarted, word) as caught:
                phrenic.local(flags=flags)
            self.assertNotIn("phrenic.local", str(caught.exception))


if __name__ == "__main__":
    unittest.main()
