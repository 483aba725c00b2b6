"""Results in other forms: CSV, JSON lines, Parquet, JUnit, labelled arrays."""

import csv
import importlib.util
import io
import json
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock
from xml.etree import ElementTree

import numpy as np

import phrenic
from phrenic import jobs, motion
from phrenic.junit import Check, junit
from support import SessionTest

ROWS = [
    {"name": 'a "quiet", breath\nin two lines', "value": 0.1 + 0.2, "count": np.int64(3), "list": [1.0, float("nan")]},
    {"name": "Zwerchfell α", "value": None, "count": 0, "list": []},
    {"name": "", "value": float("inf"), "count": -1, "list": [2.0]},
]


class UnevenTest(unittest.TestCase):
    def test_a_table_has_the_columns_of_every_row(self):
        table = phrenic.Table([{"a": 1.5}, {"b": "x", "a": 2.0}])
        self.assertEqual(table.columns, ["a", "b"])
        self.assertEqual(list(table["b"]), [None, "x"])
        self.assertEqual(table.to_csv().splitlines(), ["a,b", "1.5,", "2.0,x"])
        self.assertIn("b", str(table).splitlines()[0])
        self.assertIn("<td", table._repr_html_())
        self.assertEqual(phrenic.Table([{}, {"n": 1.0}])["n"][1], 1)


class ResultTest(unittest.TestCase):
    physiology = jobs.Physiology(
        phrenic.Table([{"breath": "quiet", "what": "flow", "verdict": "inside"}]),
        {"quiet": {"flow": (np.arange(500.0), np.arange(500.0) ** 2)}},
    )
    study = jobs.Study(phrenic.Table([{"order": 1.0}]), {}, "", 0.1, "<html>" + 10_000 * " ")

    def test_what_a_prompt_shows_is_short(self):
        for result in (self.physiology, self.study):
            self.assertLess(len(repr(result)), 500)
            self.assertIn("<table", result._repr_html_())

    @unittest.skipIf(importlib.util.find_spec("pandas") is None, "there is no pandas: apt install python3-pandas")
    def test_results_are_dataframes(self):
        self.assertEqual(list(self.study.to_pandas()["order"]), [1.0])
        self.assertEqual(list(self.physiology.to_pandas().columns), ["breath", "what", "verdict"])
        curves = self.physiology.curves_to_pandas()
        self.assertEqual(list(curves.columns), ["breath", "what", "time_s", "value"])
        self.assertEqual((len(curves), curves["value"].max()), (500, 499.0**2))


class TableTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.table = phrenic.Table(ROWS)

    def test_csv_is_read_back_with_every_digit(self):
        text = self.table.to_csv(self.folder / "t.csv")
        self.assertEqual((self.folder / "t.csv").read_bytes(), text.encode())
        self.assertIn("\r\n", text, "RFC 4180")
        rows = list(csv.DictReader(io.StringIO(text, newline="")))
        self.assertEqual([row["name"] for row in rows], [row["name"] for row in ROWS])
        self.assertEqual(float(rows[0]["value"]), 0.1 + 0.2)
        self.assertEqual([row["value"] for row in rows[1:]], ["", "inf"])
        self.assertEqual([row["count"] for row in rows], ["3", "0", "-1"])
        self.assertEqual(json.loads(rows[2]["list"]), [2.0])

    def test_json_lines_are_json(self):
        text = self.table.to_json_lines(self.folder / "t.jsonl")
        self.assertEqual((self.folder / "t.jsonl").read_bytes(), text.encode())

        def refuse(name):
            raise AssertionError(f"{name} is no JSON")

        rows = [json.loads(line, parse_constant=refuse) for line in text.splitlines()]
        self.assertEqual(rows[0], {"name": ROWS[0]["name"], "value": 0.1 + 0.2, "count": 3, "list": [1.0, None]})
        self.assertEqual([row["value"] for row in rows], [0.1 + 0.2, None, None])

    def test_an_empty_table_is_one_in_every_form(self):
        empty = phrenic.Table([])
        self.assertEqual((empty.to_csv().strip(), empty.to_json_lines()), ("", ""))

    def test_a_missing_package_is_an_error_with_a_remedy(self):
        with mock.patch.dict(sys.modules, {"pyarrow": None, "pandas": None}):
            with self.assertRaisesRegex(ModuleNotFoundError, "to_parquet needs pyarrow: pip install pyarrow"):
                self.table.to_parquet(self.folder / "t.parquet")
            with self.assertRaisesRegex(ModuleNotFoundError, "to_pandas needs pandas: apt install python3-pandas"):
                self.table.to_pandas()
        self.assertFalse((self.folder / "t.parquet").exists())

    @unittest.skipIf(importlib.util.find_spec("pyarrow") is None, "there is no pyarrow: pip install pyarrow")
    def test_parquet_is_read_back(self):
        from pyarrow import parquet

        self.table.to_parquet(self.folder / "t.parquet")
        rows = parquet.read_table(self.folder / "t.parquet").to_pylist()
        self.assertEqual([row["name"] for row in rows], [row["name"] for row in ROWS])
        self.assertEqual([row["value"] for row in rows], [row["value"] for row in ROWS])

    def test_parquets_writer_gets_the_rows(self):
        made = mock.Mock()
        pyarrow = mock.Mock(Table=mock.Mock(from_pylist=mock.Mock(return_value=made)))
        writer = mock.Mock()
        with mock.patch.dict(sys.modules, {"pyarrow": pyarrow, "pyarrow.parquet": writer}):
            self.table.to_parquet("t.parquet")
        (rows,) = pyarrow.Table.from_pylist.call_args.args
        self.assertEqual((type(rows[0]["count"]), rows[1]["value"]), (int, None))
        writer.write_table.assert_called_once_with(made, "t.parquet")


class JUnitTest(unittest.TestCase):
    def rows(self, *verdicts):
        of_all = {"breath": "quiet", "unit": "l", "value": 0.123456, "low": 0.3, "high": 0.7, "note": "", "source": "s"}
        return phrenic.Table({**of_all, "what": verdict, "verdict": verdict} for verdict in verdicts)

    def test_a_breath_outside_its_range_is_a_failed_test(self):
        physiology = jobs.Physiology(self.rows("inside", "outside", "not_modelled", "not_judged"), {})
        suite = ElementTree.fromstring(physiology.to_junit(suite="thorax")).find("testsuite")
        self.assertEqual([suite.get(name) for name in ("name", "tests", "failures", "skipped")], ["thorax", "4", "1", "2"])
        failures = {case.get("name"): case.find("failure") for case in suite}
        self.assertEqual(failures["quiet: outside"].get("message"), "0.1235 is outside 0.3 to 0.7 l")
        self.assertIsNone(failures["quiet: inside"])

    def test_any_text_is_xml(self):
        text = "a<b & \"c\" \x00\x1b\ud800 é"
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "t.xml")
            junit(text, [Check(text, failure=text)], path)
            case = ElementTree.parse(path).getroot().find("testsuite/testcase")
        self.assertEqual(case.get("name"), "a<b & \"c\" \ufffd\ufffd\ufffd é")


class MotionTest(SessionTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.frames = list(self.session("pressure-lungs").play(0.4, fps=10))

    def test_arrays_have_names_units_and_the_same_numbers(self):
        made = motion.Motion.of(iter(self.frames), scene="pressure-lungs")
        for body in self.frames[0].bodies:
            variable = made.variables[body]
            self.assertEqual(variable.dims, ("time", f"{body}_vertex", "axis"))
            self.assertEqual(variable.attributes["units"], "m")
            np.testing.assert_array_equal(variable.values[2], self.frames[2][body].positions)
        self.assertEqual(made.variables["flow"].attributes["units"], "m^3/s")
        self.assertEqual(made.attributes["scene"], "pressure-lungs")
        self.assertEqual(made.attributes["state_hash"], self.frames[-1].state_hash)

    def test_bodies_can_be_chosen_and_mistakes_are_named(self):
        made = motion.Motion.of(self.frames, bodies=["balloon"])
        self.assertNotIn("diaphragm", made.variables)
        with self.assertRaisesRegex(phrenic.errors.NotFound, "did you mean balloon"):
            motion.Motion.of(self.frames, bodies=["baloon"])
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "a motion needs one"):
            motion.Motion.of([])
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "flush has another meaning"):
            motion.to_netcdf(self.frames, self.folder / "m.nc", flush="x")

    def test_frames_without_bodies_have_measures(self):
        frames = list(self.session("pressure-lungs").play(0.2, fps=10, read=()))
        made = motion.Motion.of(frames)
        self.assertEqual(list(made.variables), list(frames[0].measures))

    @unittest.skipIf(importlib.util.find_spec("scipy") is None, "there is no scipy: apt install python3-scipy")
    def test_netcdf_is_read_back(self):
        from scipy.io import netcdf_file

        motion.to_netcdf(self.frames, self.folder / "m.nc", scene="pressure-lungs")
        with netcdf_file(self.folder / "m.nc", mmap=False) as file:
            np.testing.assert_array_equal(file.variables["time"][:], [frame.time for frame in self.frames])
            np.testing.assert_array_equal(file.variables["balloon"][3], self.frames[3]["balloon"].positions)
            np.testing.assert_array_equal(file.variables["balloon_triangles"][:], self.frames[0]["balloon"].triangles)
            self.assertEqual(file.variables["lung volume"].units, b"m^3")
            self.assertEqual(file.variables["state_hash"][1].tobytes().decode(), self.frames[1].state_hash)
            self.assertEqual(file.scene, b"pressure-lungs")

    def test_a_missing_package_is_an_error_with_a_remedy(self):
        for call, missing, remedy in (
            (lambda: motion.to_xarray(self.frames), "xarray", "apt install python3-xarray"),
            (lambda: motion.to_zarr(self.frames, self.folder / "m.zarr"), "zarr", "python3-zarr"),
            (lambda: motion.to_netcdf(self.frames, self.folder / "m.nc"), "scipy", "apt install python3-scipy"),
        ):
            hidden = {missing: None, f"{missing}.io": None}
            with mock.patch.dict(sys.modules, hidden):
                with self.assertRaisesRegex(ModuleNotFoundError, f"needs {missing}.*{remedy}"):
                    call()

    def test_xarray_gets_dimensions_arrays_and_attributes(self):
        xarray = mock.Mock()
        with mock.patch.dict(sys.modules, {"xarray": xarray}):
            motion.to_xarray(self.frames, ["balloon"], scene="pressure-lungs")
        variables, coordinates, attributes = xarray.Dataset.call_args.args
        dims, values, shown = variables["balloon"]
        self.assertEqual((dims, shown["units"]), (("time", "balloon_vertex", "axis"), "m"))
        self.assertEqual(values.shape, (len(self.frames), len(self.frames[0]["balloon"].positions), 3))
        self.assertEqual(set(coordinates), {"time", "tick", "axis", "state_hash"})
        self.assertEqual(attributes["scene"], "pressure-lungs")

    @unittest.skipIf(importlib.util.find_spec("xarray") is None, "there is no xarray: apt install python3-xarray")
    def test_xarray_selects_by_time_and_reads_what_netcdf_holds(self):
        import xarray

        dataset = motion.to_xarray(self.frames, scene="pressure-lungs")
        chosen = dataset["balloon"].sel(time=0.2, method="nearest")
        np.testing.assert_array_equal(chosen, self.frames[1]["balloon"].positions)
        motion.to_netcdf(self.frames, self.folder / "m.nc", scene="pressure-lungs")
        with xarray.open_dataset(self.folder / "m.nc", engine="scipy") as read:
            self.assertEqual(set(read.variables), set(dataset.variables))
            for name in ("balloon", "flow", "time"):
                np.testing.assert_array_equal(read[name], dataset[name])
            self.assertEqual([str(each) for each in read["state_hash"].astype(str).values],
                             [frame.state_hash for frame in self.frames])  # fmt: skip

    @unittest.skipIf(importlib.util.find_spec("zarr") is None, "there is no zarr: apt install python3-zarr")
    def test_zarr_is_read_back(self):
        import xarray

        for _ in range(2):  # a store that is there is replaced
            motion.to_zarr(self.frames, self.folder / "m.zarr", scene="pressure-lungs")
        with xarray.open_zarr(self.folder / "m.zarr") as read:
            np.testing.assert_array_equal(read["balloon"], motion.to_xarray(self.frames)["balloon"])
            self.assertEqual(read.attrs["scene"], "pressure-lungs")
