"""Pulls, pins and their replay."""

from typing import Any

import aspic
import numpy as np
import pytest
from conftest import set_arguments, simulation, small


def act(sim: aspic.Simulation) -> None:
    """Two hands pull, one lets go, some particles are pinned and freed."""
    sim.step(20)
    sim.pulls = [aspic.Pull(0, (0.0, 4.0, 0.0), 200.0, 5.0), aspic.Pull(63, [1, 5, 1], 80.0)]
    sim.step(30)
    sim.pulls = sim.pulls[1:]
    sim.pinned = [5, 6]
    sim.step(30)
    sim.pulls = ()
    sim.pinned = []
    sim.step(20)


def test_inputs_repeat_on_every_backend_and_in_the_program(sim: aspic.Simulation, program: Any) -> None:
    alone = simulation(sim.scene, sim.backend)
    alone.step(100)
    act(sim)
    assert sim.hash != alone.hash
    sim.save_inputs("hands.toml")
    assert open("hands.toml", encoding="utf-8").read() == sim.input_log
    for backend in ("reference", "cpu"):
        again = simulation(sim.scene, backend)
        again.replay("hands.toml")
        again.step(60)
        assert len(again.pulls) == 1 and again.pinned.tolist() == [5, 6]
        again.step(40)
        assert again.hash == sim.hash and again.input_log == sim.input_log
    run = program(
        "run", "cube-plane", *set_arguments(small), "--steps", "100", "--backend", "cpu", "--replay", "hands.toml"
    )
    assert run["state_hash"] == sim.hash


def test_one_pull_needs_no_list_and_channels_are_kept(sim: aspic.Simulation) -> None:
    sim.pulls = aspic.Pull(3, (0, 9, 0), 10.0)
    sim.channels = np.array([0.5, -2])
    sim.step(5)
    assert sim.channels == (0.5, -2.0) and [pull.particle for pull in sim.pulls] == [3]
    sim.pulls = ()
    assert sim.channels == (0.5, -2.0) and "channels = [0.5, -2.0]" in sim.input_log
    sim.save_inputs("channels.toml")
    again = simulation(sim.scene, "reference")
    again.replay("channels.toml")
    again.step(5)
    assert again.channels == sim.channels and again.hash == sim.hash
    with pytest.raises(aspic.UsageError, match="channel"):
        sim.channels = [float("nan")]
    assert sim.channels == (0.5, -2.0)


def test_states_bring_their_inputs_back(sim: aspic.Simulation) -> None:
    start = sim.save()
    act(sim)
    end, log = sim.hash, sim.input_log
    sim.load(start)
    assert sim.pulls == () and sim.input_log != log
    act(sim)
    assert sim.hash == end and sim.input_log == log


def test_pins_are_the_scenes_and_ones_own(scene: aspic.Scene) -> None:
    scene["cube[0].pinned"] = ["top"]
    sim = aspic.Simulation(scene, "cpu")
    top = sim.pinned
    assert len(top) == 16
    sim.pinned = np.arange(64) < 3
    assert sim.pinned.tolist() == [0, 1, 2]
    before = sim.positions
    sim.step(100)
    moved = np.any(sim.positions != before, axis=1)
    assert not moved[:3].any() and moved[top[top > 2]].all()
    sim.pinned = top
    assert sim.pinned.tolist() == top.tolist() and sim.input_log.count("pinned") <= 1
    for wrong in ([64], [-1], [0.5], np.ones(3, bool)):
        with pytest.raises(aspic.UsageError):
            sim.pinned = wrong  # type: ignore[assignment]


def test_a_pull_draws_a_ball_along() -> None:
    sim = aspic.Simulation("cube-and-balls", "cpu")
    other = aspic.Simulation("cube-and-balls", "cpu")
    sim.pulls = [aspic.Pull(0, (0.0, 9.0, 0.0), 50.0, 1.0, ball=True)]
    for each in (sim, other):
        each.step(300)
    assert sim["ball[0]"].position[1] > other["ball[0]"].position[1]


@pytest.mark.parametrize(
    ("pull", "says"),
    [
        (aspic.Pull(64, (0, 0, 0), 1.0), "64"),
        (aspic.Pull(0, (0, 0, 0), -1.0), "stiffness"),
        (aspic.Pull(0, (0, float("nan"), 0), 1.0), "finite"),
        (aspic.Pull(0, (0, 0, 0), 1.0, ball=True), "ball"),
        (aspic.Pull(-1, (0, 0, 0), 1.0), "index"),
    ],
)
def test_wrong_pulls_change_nothing(scene: aspic.Scene, pull: aspic.Pull, says: str) -> None:
    sim = aspic.Simulation(scene, "cpu")
    sim.pulls = [aspic.Pull(1, (0, 0, 0), 1.0)]
    with pytest.raises(aspic.UsageError, match=says):
        sim.pulls = [aspic.Pull(0, (0, 0, 0), 1.0), pull]
    assert sim.pulls == (aspic.Pull(1, (0.0, 0.0, 0.0), 1.0, 0.0, False),)


def test_a_wrong_log_names_its_line(scene: aspic.Scene) -> None:
    sim = aspic.Simulation(scene, "cpu")
    sim.save_inputs("none.toml")
    with pytest.raises(FileExistsError):
        sim.save_inputs("none.toml")
    text = sim.input_log + "[[input]]\nstep = 1\npuls = []\n"
    open("wrong.toml", "w", encoding="utf-8").write(text)
    with pytest.raises(aspic.SceneError, match="wrong.toml:"):
        sim.replay("wrong.toml")
    with pytest.raises(aspic.FileError):
        sim.replay("missing.toml")
