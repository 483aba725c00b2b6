"""Every environment keeps the contract that Gymnasium's checker checks: spaces, tuples, seeds, the end of an episode."""

import importlib.util
import pkgutil
import re
import sys
import unittest
from unittest import mock

import numpy as np

import phrenic
from phrenic.gym import FollowVolume, KeepBreathing, VentilateCopd
from phrenic.vector import FollowVolumeVector, KeepBreathingVector, VentilateCopdVector
from support import REPOSITORY


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


class RegistrationTest(unittest.TestCase):
    def test_each_environment_is_registered_with_its_vector(self):
        gymnasium = mock.Mock()
        with mock.patch.dict(sys.modules, {"gymnasium": gymnasium}):
            phrenic.gym.register()
        made = {call.kwargs["id"]: call.kwargs for call in gymnasium.register.call_args_list}
        self.assertEqual(set(made), {f"phrenic/{name}-v0" for name in ("VentilateCopd", "FollowVolume", "KeepBreathing")})
        for each in made.values():
            single, many = (pkgutil.resolve_name(each[key]) for key in ("entry_point", "vector_entry_point"))
            self.assertIs(single.task, many.task)

    def test_pip_tells_gymnasium_of_them(self):
        text = (REPOSITORY / "client" / "python" / "pyproject.toml").read_text()
        (point,) = re.findall(r'^\[project.entry-points."gymnasium.envs"\]\nphrenic = "(.*)"$', text, re.MULTILINE)
        self.assertIs(pkgutil.resolve_name(point), phrenic.gym.register)

    @unittest.skipIf(importlib.util.find_spec("gymnasium") is None, "there is no gymnasium: pip install gymnasium")
    def test_gymnasiums_own_checker_finds_nothing(self):
        import gymnasium
        from gymnasium.utils.env_checker import check_env

        phrenic.gym.register()
        for name in phrenic.gym.ENVIRONMENTS:
            with gymnasium.make(f"phrenic/{name}-v0", resolution_mm=12, seconds=0.3) as env:
                check_env(env.unwrapped, skip_render_check=True)
            with gymnasium.make_vec(f"phrenic/{name}-v0", num_envs=2, resolution_mm=12, seconds=0.3) as envs:
                self.assertIn(envs.reset(seed=1)[0], envs.observation_space)


class TasksTest(unittest.TestCase):
    def test_muscle_moves_air_and_the_actions_have_their_own_effect(self):
        with FollowVolume(resolution_mm=12, seconds=2, interval=0.5) as env:
            moved = {}
            for action in ((0, 0), (0.2, 0), (0, 0.5)):
                env.reset(seed=0)
                moved[action] = [env.step(np.array(action, np.float32))[0][0] for _ in range(4)][-1]
        self.assertGreater(moved[0.2, 0], moved[0, 0] + 0.05)
        self.assertGreater(moved[0, 0.5], moved[0, 0] + 0.05)

    def test_a_paralysed_patient_suffocates_unless_it_is_ventilated(self):
        with KeepBreathing(resolution_mm=12, seconds=9, interval=0.5) as env:
            for rate, ending in ((0, (-10.0, True, False)), (0.25, None)):
                env.reset(seed=0)
                for i in range(18):
                    pressure = 1.0 if rate and (i * 0.5 * rate) % 1 < 0.5 else 0.0
                    _, *end, _ = env.step(np.array([pressure], np.float32))
                    if end[1] or end[2]:
                        break
                if ending:
                    self.assertEqual(tuple(end), ending)
                else:
                    self.assertEqual(end[1:], [False, True])


class VectorTest(unittest.TestCase):
    OPTIONS = {"resolution_mm": 12, "seconds": 0.3}

    def test_each_patient_is_that_of_the_single_environment(self):
        for Vector, Single in ((VentilateCopdVector, VentilateCopd), (FollowVolumeVector, FollowVolume)):
            patients = Vector(3, threads=2, **self.OPTIONS)
            patients.action_space.seed(5)
            actions = [patients.action_space.sample() for _ in range(3)]
            first, infos = patients.reset(seed=[4, 5, 4])
            steps = [patients.step(action) for action in actions]
            self.assertIn(first, patients.observation_space)
            self.assertEqual(steps[0][1].shape, (3,))
            for i, seed in enumerate((4, 5, 4)):
                with Single(**self.OPTIONS) as env:
                    observation, info = env.reset(seed=seed)
                    np.testing.assert_array_equal(observation, first[i])
                    self.assertEqual(info["state_hash"], infos["state_hash"][i])
                    for action, (rows, rewards, terminated, truncated, more) in zip(actions, steps):
                        observation, reward, *ends, info = env.step(action[i])
                        np.testing.assert_array_equal(observation, rows[i])
                        self.assertEqual(reward, rewards[i])
                        self.assertEqual(ends, [terminated[i], truncated[i]])
                        self.assertEqual(info["state_hash"], more["state_hash"][i])

    def test_a_patient_whose_episode_has_ended_begins_anew_with_the_next_step(self):
        patients = VentilateCopdVector(2, **self.OPTIONS)
        first, _ = patients.reset(seed=7)
        still = np.zeros((2, 1), np.float32)
        *_, truncated, _ = [patients.step(still) for _ in range(3)][-1]
        self.assertTrue(truncated.all())
        observations, rewards, terminated, truncated, infos = patients.step(still)
        self.assertEqual((rewards.tolist(), infos["seconds"].tolist()), ([0, 0], [0, 0]))
        self.assertFalse((terminated | truncated).any())
        self.assertEqual(observations[0][0], first[0][0])
        *_, infos = patients.step(still)
        self.assertAlmostEqual(infos["seconds"][0], 0.1, 2)

    def test_a_step_ignores_the_actions_of_patients_whose_episode_has_ended(self):
        patients = VentilateCopdVector(2, **self.OPTIONS)
        patients.reset(seed=7)
        still = np.zeros((2, 1), np.float32)
        for _ in range(3):
            patients.step(still)
        _, rewards, *_ = patients.step(np.full((2, 1), np.nan, np.float32))
        self.assertEqual(rewards.tolist(), [0, 0])

    def test_a_reset_or_step_that_fails_leaves_the_episodes_as_they_were(self):
        patients, same = (VentilateCopdVector(2, **self.OPTIONS) for _ in range(2))
        push = np.ones((2, 1), np.float32)
        for each in (patients, same):
            each.reset(seed=np.array([3, 4]))
            each.step(push)
        for options in ({"airway_resistanse": 5}, {"airway_resistance": -1}, [1]):
            with self.assertRaises(phrenic.errors.InvalidArgument):
                patients.reset(seed=9, options=options)
        with self.assertRaises(phrenic.errors.InvalidArgument):
            patients.step([["a"], [1]])
        for (rows, rewards, *_), (expected, others, *_) in ((patients.step(push), same.step(push)),):
            np.testing.assert_array_equal(rows, expected)
            np.testing.assert_array_equal(rewards, others)

    def test_seeds_come_in_an_array_and_a_closed_environment_takes_no_step(self):
        patients = VentilateCopdVector(2, **self.OPTIONS)
        rows = [patients.reset(seed=seed)[0] for seed in ([1, 2], np.array([1, 2]), 1, np.int64(1), (1, 2))]
        for row in rows[1:]:
            np.testing.assert_array_equal(row, rows[0])
        for seed in ("12", [1.5, 2], 1.5, np.array([1])):
            with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "seed"):
                patients.reset(seed=seed)
        patients.close()
        with self.assertRaisesRegex(phrenic.errors.FailedPrecondition, "reset"):
            patients.step(np.zeros((2, 1), np.float32))

    def test_wrong_requests_are_refused(self):
        patients = KeepBreathingVector(2, **self.OPTIONS)
        with self.assertRaisesRegex(phrenic.errors.FailedPrecondition, "reset"):
            patients.step(np.zeros((2, 1), np.float32))
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "3 seeds for 2"):
            patients.reset(seed=[1, 2, 3])
        patients.reset(seed=1)
        for actions in (np.zeros((3, 1)), np.zeros(2), np.full((2, 1), 4), np.full((2, 1), np.nan)):
            with self.assertRaises(phrenic.errors.InvalidArgument):
                patients.step(actions.astype(np.float32))
