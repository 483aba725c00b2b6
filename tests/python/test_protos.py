"""The protos compile with old versions of protoc too, and mean the same."""

import doctest
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from google.protobuf import descriptor_pb2

from support import REPOSITORY

PROTOS = REPOSITORY / "proto"
SCRIPT = PROTOS / "without_optional.py"

WRITE_AND_READ = """
from phrenic.v1 import access_pb2
request = access_pb2.CreateLinkRequest(session_id="s")
assert not request.HasField("time_to_live")
request.time_to_live = 0
assert request.HasField("time_to_live")
print(request.SerializeToString().hex())
"""


def load():
    spec = importlib.util.spec_from_file_location("without_optional", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run(*words, **options):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=120, **options)


def names_of(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.glob("phrenic/v1/*.proto"))


def described(folder: Path, out: Path) -> descriptor_pb2.FileDescriptorSet:
    done = run("protoc", "-I", folder, f"--descriptor_set_out={out}", *names_of(folder))
    assert done.returncode == 0, done.stderr
    return descriptor_pb2.FileDescriptorSet.FromString(out.read_bytes())


def fields_of(message: descriptor_pb2.DescriptorProto, scope: str) -> dict:
    """What counts of each field: name, number, type, options, and the oneof that it is in."""
    found = {}
    for field in message.field:
        oneof = message.oneof_decl[field.oneof_index].name if field.HasField("oneof_index") else ""
        field.ClearField("oneof_index")
        field.ClearField("proto3_optional")
        found[f"{scope}.{message.name}.{field.name}"] = (field.SerializeToString(), oneof)
    for nested in message.nested_type:
        found |= fields_of(nested, f"{scope}.{message.name}")
    return found


class OldProtocTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        done = run(sys.executable, SCRIPT, self.folder / "old")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_examples_of_the_script(self):
        self.assertEqual(doctest.testmod(load()).failed, 0)

    def test_a_semicolon_in_a_string_ends_no_field(self):
        text = "  optional A.B c = 1\n      [(o) = {help: \"a \\\"; b\" x: 'c;'}];\n"
        self.assertEqual(
            load().without_optional(text), "  oneof _c { A.B c = 1\n      [(o) = {help: \"a \\\"; b\" x: 'c;'}]; }\n"
        )

    def test_no_optional_is_left_and_every_file_is_there(self):
        self.assertEqual(names_of(self.folder / "old"), names_of(PROTOS))
        for path in (self.folder / "old").glob("phrenic/v1/*.proto"):
            self.assertNotRegex(path.read_text(), r"(?m)^\s*optional ", path.name)

    def test_every_field_stays_what_it_is(self):
        if not shutil.which("protoc"):
            self.skipTest("there is no protoc: apt install protobuf-compiler")
        ours, old = (described(f, self.folder / "set") for f in (PROTOS, self.folder / "old"))
        for a, b in zip(ours.file, old.file):
            self.assertEqual(a.name, b.name)
            self.assertEqual([e.SerializeToString() for e in a.enum_type], [e.SerializeToString() for e in b.enum_type])
            self.assertEqual([s.SerializeToString() for s in a.service], [s.SerializeToString() for s in b.service])
            for one, other in zip(a.message_type, b.message_type):
                self.assertEqual(fields_of(one, a.package), fields_of(other, b.package))

    def test_debians_grpc_tools_compile_them(self):
        if importlib.util.find_spec("grpc_tools") is None:
            self.skipTest("there is no grpc_tools: apt install python3-grpc-tools")
        out, old = self.folder / "out", self.folder / "old"
        out.mkdir()
        words = [sys.executable, "-m", "grpc_tools.protoc", f"--python_out={out}", f"--grpc_python_out={out}"]
        done = run(*words, "-I", old, *names_of(old))
        self.assertEqual(done.returncode, 0, done.stderr)
        # What versions before 3.19 generate runs with newer runtimes by this setting alone.
        environment = {**os.environ, "PYTHONPATH": str(out), "PROTOCOL_BUFFERS_PYTHON_IMPLEMENTATION": "python"}
        made = run(sys.executable, "-c", WRITE_AND_READ, env=environment)
        self.assertEqual(made.returncode, 0, made.stderr)
        ours = run(sys.executable, "-c", WRITE_AND_READ, env=dict(os.environ))
        self.assertEqual(made.stdout, ours.stdout, ours.stderr)
