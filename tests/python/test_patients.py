"""A patient of label files has a scene that runs, or a verdict with reasons, and leaves nothing on the server."""

import gzip
import struct
import subprocess
import tempfile
import unittest
from functools import lru_cache
from pathlib import Path

import numpy as np

import phrenic
from support import SessionTest, program


@lru_cache
def phantom() -> bytes:
    """A coarse phantom with names, as NIfTI."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "phantom.nii.gz")
        subprocess.run([program("phrenic"), "phantom", "--voxel", "5", "--out", path], check=True, capture_output=True)
        return gzip.decompress(path.read_bytes())


def write(path: Path, keep: "list[int] | None" = None, to: "int | None" = None, slab: bool = False) -> Path:
    """Writes labels of the phantom, without their names: all, or some as one number, or the lower half of the slices."""
    data = bytearray(phantom())
    start = int(struct.unpack_from("<f", data, 108)[0])
    voxels = np.frombuffer(bytes(data[start:]), "<u2").copy()
    if keep is not None:
        voxels[~np.isin(voxels, keep)] = 0
    if to is not None:
        voxels[voxels > 0] = to
    if slab:
        columns, rows, slices = struct.unpack_from("<3h", data, 42)
        struct.pack_into("<h", data, 46, slices // 2)
        voxels = voxels[: columns * rows * (slices // 2)]
    struct.pack_into("<f", data, 108, 352.0)
    path.write_bytes(gzip.compress(bytes(data[:348]) + b"\0\0\0\0" + voxels.tobytes()))
    return path


class PatientTest(SessionTest):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_a_volume_becomes_a_session_whose_steps_are_finite(self):
        said = []
        found = phrenic.patient(
            write(self.folder / "labels.nii.gz"), vertices=800, edge_length_mm=5, anyway=True,
            progress=lambda done, text: said.append(done),
        )  # fmt: skip
        self.assertEqual(said, sorted(said))
        self.assertIn(found.verdict, ("ready", "usable with care", "not usable"))
        self.assertIn("rib-5-left", list(found.surfaces["body"]))
        with phrenic.Session(found.scene) as s:
            self.assertTrue(np.isfinite(s.step(3)["diaphragm"].positions).all())

    def test_files_of_one_patient_are_as_one_file(self):
        lungs = {"lung_upper_lobe_left": [10], "lung_upper_lobe_right": [12]}
        for name, numbers in lungs.items():
            write(self.folder / f"{name}.nii.gz", numbers, 1)
        write(self.folder / "labels.nii.gz", [5, 51, *range(27, 44), *range(92, 118)])
        found = phrenic.patient(self.folder, vertices=800, edge_length_mm=12, anyway=True)
        self.assertEqual({row["body"] for row in found.surfaces if row["body"].startswith("lung")},
                         {"lung-upper-lobe-left", "lung-upper-lobe-right"})  # fmt: skip
        self.assertIn("labels.nii.gz", " ".join(found.assumptions))

    def test_a_slab_is_refused_with_reasons(self):
        found = phrenic.patient(write(self.folder / "labels.nii.gz", slab=True), vertices=800, edge_length_mm=12)
        self.assertEqual(found.verdict, "not usable")
        self.assertGreater(len(found.findings), 0)
        with self.assertRaisesRegex(phrenic.errors.FailedPrecondition, "not usable"):
            found.scene

    def test_what_is_wrong_is_named(self):
        labels = write(self.folder / "labels.nii.gz")
        for files, options, words in (
            ([], {}, "files: is empty"),
            (self.folder / "none.nii.gz", {}, "No such file"),
            (labels, {"map": "mooze"}, "map: there is no label map"),
            (labels, {"labels": {5: "lever"}}, "did you mean liver"),
        ):
            with self.assertRaisesRegex(phrenic.errors.InvalidArgument, words):
                phrenic.patient(files, **options)


if __name__ == "__main__":
    unittest.main()
