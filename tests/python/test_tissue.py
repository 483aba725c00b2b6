"""Lung tissue by arrays: it is that of the server, and its integrals agree with each other."""

import unittest

import numpy as np

import phrenic
from support import SessionTest


class TissueTest(SessionTest):
    def test_a_persons_tissue_moves_as_its_surface_does(self):
        s = self.session("person-1")
        rest = s.frame()
        now = s.step(s.ticks_until(s.parameters["breath_length"] / 2))
        tissue = s.tissue()
        self.assertEqual((tissue.tick, list(tissue.lungs)), (now.tick, ["lung-right", "lung-left"]))
        for name in tissue.lungs:
            moved = now[name].positions - rest[name].positions
            chosen = np.argsort(-np.linalg.norm(moved, axis=1))[:64]
            read = s.tissue(rest[name].positions[chosen]).points
            for i, axis in enumerate(("dx", "dy", "dz")):
                inside = read["lung"] == name
                self.assertGreater(np.sum(inside), 20)
                np.testing.assert_allclose(read[axis][inside], moved[chosen][inside, i], atol=1e-6)

    def test_the_arrays_are_those_of_the_readings(self):
        s = self.session("person-1")
        s.step(s.ticks_until(s.parameters["breath_length"] / 2))
        for name, lung in s.tissue().lungs.items():
            lattice = lung.lattice
            self.assertEqual(lung.displacement.shape, lattice.nodes.shape)
            self.assertAlmostEqual(np.sum(lung.ventilation * lattice.volumes) / lung.volume, 1, delta=0.05)
            k = int(np.argmax(lattice.volumes))  # a brick that is inside
            point = s.tissue([lattice.centres[k]]).points[0]
            self.assertEqual(point["lung"], name)
            self.assertAlmostEqual(point["ventilation"], lung.ventilation[k], places=6)
            self.assertAlmostEqual(point["strain"], lung.strain[k], places=6)
            base, apex = lung.regions[0], lung.regions[2]
            self.assertEqual((base["name"], apex["name"]), ("base", "apex"))
            self.assertGreater(base["descent"], apex["descent"])

    def test_what_has_no_lungs_is_refused(self):
        with self.assertRaisesRegex(phrenic.errors.FailedPrecondition, "lungs"):
            self.session().tissue()


if __name__ == "__main__":
    unittest.main()
