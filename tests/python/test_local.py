"""A server in the process's care ends with it, however that ends."""

import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import phrenic

CHILD = """
import phrenic, sys, threading
def start():
    global server
    server = phrenic.local()
thread = threading.Thread(target=start)   # the thread that asked for it may end before it
thread.start(); thread.join()
print(server.process.pid, server.log if hasattr(server, "log") else server.process.log, flush=True)
server.scenes()
sys.stdin.read()
"""


def lives(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def await_end(pid: int) -> bool:
    for _ in range(1000):
        if not lives(pid):
            return True
        time.sleep(0.01)
    return False


class LocalTest(unittest.TestCase):
    def child(self):
        child = subprocess.Popen(
            [sys.executable, "-c", CHILD], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self.addCleanup(child.stdout.close)
        self.addCleanup(child.wait)
        self.addCleanup(child.kill)
        pid, _, log = child.stdout.readline().partition(" ")
        self.assertTrue(lives(int(pid)))
        return child, int(pid), Path(log.strip()).parent

    def test_it_ends_with_a_process_that_ends(self):
        child, pid, folder = self.child()
        child.stdin.close()
        self.assertEqual(child.wait(20), 0)
        self.assertTrue(await_end(pid))
        self.assertFalse(folder.exists())

    def test_it_ends_with_a_process_that_is_killed_and_the_next_one_tidies_up(self):
        child, pid, folder = self.child()
        child.send_signal(signal.SIGKILL)
        child.wait()
        child.stdin.close()
        self.assertTrue(await_end(pid))
        with phrenic.local():
            self.assertFalse(folder.exists())

    def test_it_ends_when_it_is_closed(self):
        server = phrenic.local()
        pid, folder = server.process.pid, server.process.log.parent
        self.assertEqual(server.version, phrenic.__version__)
        self.assertNotEqual(os.getpgid(pid), os.getpgid(0), "Ctrl-C would end it")
        self.assertTrue(server.address.startswith("127.0.0.1:"))
        server.close()
        server.close()
        self.assertFalse(lives(pid))
        self.assertFalse(folder.exists())

    def test_a_server_that_does_not_start_says_why(self):
        with self.assertRaisesRegex(phrenic.errors.Unavailable, "--nonsense"):
            phrenic.local(flags=["--nonsense"])
        with self.assertRaisesRegex(phrenic.errors.Unavailable, "/no/phrenicd is not a program"):
            phrenic.local(program="/no/phrenicd")

    def test_settings_of_other_servers_do_not_reach_it(self):
        os.environ["PHRENICD_TOKENS"] = "/no/tokens"
        self.addCleanup(os.environ.pop, "PHRENICD_TOKENS")
        with phrenic.local() as server:
            self.assertIn("thorax", server.scenes()["name"])

    def test_the_data_folder_holds_scenes(self):
        with tempfile.TemporaryDirectory() as folder:
            scenes = Path(folder, "scenes")
            scenes.mkdir()
            (scenes / "mine.textproto").write_text(
                "name: 'mine' bodies { name: 'dot' role: ROLE_DEFORMABLE mass: 1 "
                "grid { columns: 2 rows: 2 u { x: 1 } v { y: 1 } } }"
            )
            with phrenic.local(data=folder) as server, phrenic.Session("mine", server=server) as session:
                self.assertEqual(session.step(1).bodies, ["dot"])
