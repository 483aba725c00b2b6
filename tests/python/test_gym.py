"""The environment keeps the contract that Gymnasium's checker checks: spaces, tuples, seeds, the end of an episode."""

import unittest

import numpy as np

import phrenic
from phrenic.gym import VentilateCopd


class GymTest(unittest.TestCase):
    """One environment for all: a thorax takes seconds to compile."""

    @classmethod
    def setUpClass(cls):
        cls.env = VentilateCopd(resolution_mm=12, seconds=0.3)
        cls.addClassCleanup(cls.env.close)

    def episode(self, seed, pressures, **options):
        observation, _ = self.env.reset(seed=seed, options=options)
        return [observation] + [self.env.step(np.array([p], np.float32)) for p in pressures]

    def test_observations_and_actions_are_in_their_spaces(self):
        observation, info = self.env.reset(seed=0)
        self.assertIn(observation, self.env.observation_space)
        self.assertEqual(observation.dtype, np.float32)
        self.assertIsInstance(info, dict)
        self.env.action_space.seed(3)
        action = self.env.action_space.sample()
        self.assertIn(action, self.env.action_space)
        self.env.action_space.seed(3)
        np.testing.assert_array_equal(self.env.action_space.sample(), action)
        observation, reward, terminated, truncated, info = self.env.step(action)
        self.assertIn(observation, self.env.observation_space)
        self.assertIsInstance(reward, float)
        self.assertIs(type(terminated), bool)
        self.assertIs(type(truncated), bool)

    def test_an_episode_is_truncated_at_its_length_and_then_over(self):
        steps = self.episode(1, [1, 1, 1])[1:]
        self.assertEqual([truncated for _, _, _, truncated, _ in steps], [False, False, True])
        self.assertFalse(any(terminated for _, _, terminated, _, _ in steps))
        with self.assertRaisesRegex(phrenic.errors.FailedPrecondition, "reset"):
            self.env.step(np.array([1], np.float32))

    def test_equal_seeds_and_actions_give_equal_states_and_others_do_not(self):
        first, again, other = (self.episode(seed, [1, 2])[-1] for seed in (4, 4, 5))
        np.testing.assert_array_equal(first[0], again[0])
        self.assertEqual(first[4]["state_hash"], again[4]["state_hash"])
        self.assertNotEqual(first[0][3], other[0][3], "the seed changes the patient's target")
        weak = self.episode(4, [1, 0.5])[-1]
        self.assertNotEqual(first[4]["state_hash"], weak[4]["state_hash"])

    def test_pressure_moves_air_and_resistance_holds_it_back(self):
        pushed = self.episode(0, [2, 2])[-1][0][0]
        idle = self.episode(0, [0, 0])[-1][0][0]
        narrow = self.episode(0, [2, 2], airway_resistance=12)[-1][0][0]
        self.assertGreater(pushed, idle + 0.01)
        self.assertLess(narrow, pushed)

    def test_a_wrong_action_is_refused(self):
        self.env.reset(seed=0)
        for action in ([-1], [4], [np.nan], [1, 1], 1.0):
            with self.assertRaises(phrenic.errors.InvalidArgument):
                self.env.step(np.array(action, np.float32))
