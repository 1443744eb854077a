"""Fields: shapes in the model match the markers of the game, and robots pass through markers."""

from typing import Any

import mujoco
import numpy as np
import pytest

from lacoc_arenas import arena, field
from lacoc_arenas.game import DOWN, LEFT, NEUTRAL, RIGHT
from lacoc_shared.messages import MARKER_STATES

NAMES = ["othello", "flag-strike", "practice"]
STATE_NAMES = [*MARKER_STATES, "always"]
STATES = {
    "disc": {NEUTRAL, LEFT, RIGHT},
    "corner": {NEUTRAL, LEFT, RIGHT},
    "flag": {NEUTRAL, LEFT, RIGHT, DOWN},
}


def build(name: str, overrides: dict[str, Any] | None = None) -> Any:
    spec = mujoco.MjSpec()
    arena.load(name, overrides).build_field(spec)
    return spec


def geoms(model: Any) -> list[Any]:
    return [model.geom(index) for index in range(model.ngeom)]


@pytest.mark.parametrize("name", NAMES)
def test_names_agree(name: str) -> None:
    """A field has a marker shape for each state of each marker, and no other marker shapes."""
    game = arena.load(name).game
    shown = {
        tuple(geom.name.split(":")[1:3])
        for geom in geoms(build(name).compile())
        if geom.name.startswith("marker:")
    }
    expected = {
        (marker.name, MARKER_STATES[state])
        for marker in game.markers
        for state in STATES[marker.kind]
    }
    assert shown == expected


@pytest.mark.parametrize("name", NAMES)
def test_states_of_the_rules_have_a_shape(name: str) -> None:
    """A referee can set a marker to exactly the states that the field has shapes for."""
    game = arena.load(name).game
    for index, marker in enumerate(game.markers):
        for state in range(4):
            if state in STATES[marker.kind]:
                assert game.board(game.set(game.start(), index, state))[index] == state
            else:
                with pytest.raises(ValueError, match="neutral, left or right"):
                    game.set(game.start(), index, state)


def test_probes_are_the_poles() -> None:
    """Each flag has an invisible probe: a pole of radius 0.01 m and height 0.25 m (rules 6)."""
    game = arena.load("flag-strike").game
    model = build("flag-strike").compile()
    flags = {marker.name: marker for marker in game.markers if marker.kind == "flag"}
    probes = {g.name.split(":")[1]: g for g in geoms(model) if g.name.startswith("probe:")}
    assert probes.keys() == flags.keys()
    for name, probe in probes.items():
        assert probe.type == mujoco.mjtGeom.mjGEOM_CYLINDER
        assert tuple(probe.size[:2]) == (0.01, 0.125)
        assert tuple(probe.pos) == (flags[name].x_m, flags[name].y_m, 0.125)
        assert probe.rgba[3] == 0


def test_pole_settings_reach_the_model() -> None:
    """The settings of a pole's radius and height change the model."""
    model = build("flag-strike", {"game": {"pole_radius_m": 0.02, "pole_height_m": 0.5}}).compile()
    assert tuple(model.geom("probe:flag3").size[:2]) == (0.02, 0.25)
    assert model.geom("probe:flag3").pos[2] == 0.25


@pytest.mark.parametrize("name", NAMES)
def test_walls_stand_where_the_rules_say(name: str) -> None:
    """Four wall planes stand at the edges of the field and face inward."""
    half_m = [size / 2 for size in arena.load(name).game.size_m]
    model = build(name).compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    for side, axis, sign in (("east", 0, 1), ("west", 0, -1), ("north", 1, 1), ("south", 1, -1)):
        index = model.geom(f"wall:{side}").id
        assert data.geom_xpos[index][axis] == sign * half_m[axis]
        normal = data.geom_xmat[index].reshape(3, 3)[:, 2]
        expected = np.zeros(3)
        expected[axis] = -sign
        np.testing.assert_allclose(normal, expected, atol=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_only_floor_and_walls_can_be_touched(name: str) -> None:
    """Only the floor and the walls stop robots, and both collide with every robot."""
    model = build(name).compile()
    solid = {g.name for g in geoms(model) if g.contype[0] or g.conaffinity[0]}
    assert solid == {"floor", "wall:east", "wall:west", "wall:north", "wall:south"}
    for geom in geoms(model):
        if geom.name in solid:
            assert (geom.contype[0], geom.conaffinity[0]) == (1, 0xFFFE)
    assert model.body_mass.sum() == 0
    assert model.ngeom < 200


@pytest.mark.parametrize("name", ["othello", "flag-strike"])
def test_markers_change_no_bit_of_a_path(name: str) -> None:
    """A body that tumbles over the field takes the same path with and without markers."""
    paths = []
    for bare in (False, True):
        spec = build(name)
        body = spec.worldbody.add_body(pos=[0.0, 0.0, 0.15])
        body.add_freejoint()
        body.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            size=[0.03, 0.1, 0],
            contype=2,
            conaffinity=1,
        )
        if bare:
            for geom in list(spec.geoms):
                if geom.name.startswith(("marker:", "probe:", "rim:")):
                    spec.delete(geom)
        model = spec.compile()
        data = mujoco.MjData(model)
        data.qvel[:] = [1.5, 0.7, 0, 3, 2, 1]
        mujoco.mj_step(model, data, nstep=1500)
        paths.append(data.qpos.copy())
    assert paths[0].tobytes() == paths[1].tobytes()
    assert abs(paths[0][:2]).max() > 0.1


def colour_of(geom: Any, swap: bool) -> tuple[float, ...]:
    rgba = tuple(np.round(geom.rgba, 4))
    left, right = (tuple(np.round(np.float32(field.TINTS[s]), 4)) for s in ("left", "right"))
    return {left: right, right: left}.get(rgba, rgba) if swap else rgba


def looks(name: str, turn: bool) -> Any:
    """Return place, shape and colour of each geom; `turn` turns by 180° and swaps the seats."""
    model = build(name).compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    half_turn = np.diag([-1.0, -1.0, 1.0]) if turn else np.eye(3)
    swap = {"left": "right", "right": "left"}
    seen = []
    for index, geom in enumerate(geoms(model)):
        axes = half_turn @ data.geom_xmat[index].reshape(3, 3)
        size = geom.size
        if geom.type == mujoco.mjtGeom.mjGEOM_CYLINDER:
            size = np.array([size[0], size[0], size[1]])
        if geom.type == mujoco.mjtGeom.mjGEOM_PLANE:
            shape = np.outer(axes[:, 2], axes[:, 2])[np.triu_indices(3)]
        else:
            shape = (axes @ np.diag(size**2) @ axes.T)[np.triu_indices(3)]
        state = geom.name.split(":")[2] if geom.name.startswith("marker:") else "always"
        state = swap.get(state, state) if turn else state
        at = half_turn @ data.geom_xpos[index]
        seen.append([STATE_NAMES.index(state), geom.type[0], *at, *shape, *colour_of(geom, turn)])
    return np.array(seen, dtype=float)


@pytest.mark.parametrize("name", NAMES)
def test_field_turned_is_the_same_field(name: str) -> None:
    """The field turned by 180 degrees with the seats swapped is the same field (rules 4)."""
    here, there = looks(name, turn=False), looks(name, turn=True)
    same = abs(here[:, None] - there[None]).max(axis=2) < 1e-8
    assert (same.sum(axis=0) == 1).all()
    assert (same.sum(axis=1) == 1).all()


def test_start_places_look_like_no_target() -> None:
    """On Flag-Strike's field start places are square, unlike corners and flags."""
    model = build("flag-strike").compile()
    pads = [geom for geom in geoms(model) if geom.name.startswith("pad:")]
    assert len(pads) == 2 * len(arena.load("flag-strike").game.starts[0])
    assert {int(pad.type[0]) for pad in pads} == {int(mujoco.mjtGeom.mjGEOM_BOX)}
