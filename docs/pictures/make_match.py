"""Render docs/pictures/match-*.png: moments of real matches between two bots.

Run it from the checkout: python docs/pictures/make_match.py On a machine without a screen, set
MUJOCO_GL to egl or osmesa.
"""

import os
import zlib
from pathlib import Path
from struct import pack

os.environ.setdefault("MUJOCO_GL", "egl")

import mujoco
import numpy as np
import numpy.typing as npt

from lacoc_arenas import arena as arenas
from lacoc_robots.model import add_robot, set_options
from lacoc_server.match.entry import weigh_in
from lacoc_server.simulate import Player, player, simulate
from lacoc_shared.codec import unpack_states
from lacoc_shared.messages import MARKER_STATES, Frame
from lacoc_shared.record.schema import Setup

SIZE = 1280, 720
SCALE = 2
"""The picture is rendered this many times larger and averaged down, for smooth edges."""

MOMENTS = {"othello": 118.0, "flag-strike": 70.0}
"""Arena -> seconds of the clock at which its picture is taken."""


def main() -> None:
    """Simulate and render each picture."""
    for name, moment_s in MOMENTS.items():
        arena = arenas.load(name, {"match": {"duration_s": moment_s}})
        players = [player(arena, seat, bot) for seat, bot in enumerate(("planner", "nearest"))]
        setup = Setup(court="p", match=1, arena=name, settings=arena.settings, limits={})
        frames: list[Frame] = []
        simulate(setup, players, watch=frames.append)
        image = render(arena, players, frames[-1])
        Path(__file__).with_name(f"match-{name}.png").write_bytes(png(image))


def render(arena: arenas.Arena, players: list[Player], frame: Frame) -> npt.NDArray[np.uint8]:
    """Draw a frame.

    Returns:
        (height, width, 3) the picture.
    """
    spec = mujoco.MjSpec()
    set_options(spec)
    spec.visual.global_.offwidth, spec.visual.global_.offheight = (side * SCALE for side in SIZE)
    spec.visual.headlight.ambient = [0.42, 0.42, 0.42]
    spec.visual.headlight.diffuse = [0.25, 0.25, 0.25]
    spec.visual.quality.shadowsize = 4096
    spec.worldbody.add_light(
        pos=[-1.2, -1.6, 3.2],
        dir=[0.35, 0.45, -0.9],
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        diffuse=[0.55, 0.55, 0.55],
        castshadow=True,
    )
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=[0.93, 0.95, 0.98],
        rgb2=[0.62, 0.70, 0.80],
        width=256,
        height=256,
    )
    arena.build_field(spec)
    for seat, one in enumerate(players):
        join = one.join
        robot = weigh_in(join.robot, join.postures, join.locomotion).robot
        colour = arena.seats[seat].colour
        rgba = [*(int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)), 1.0]
        add_robot(spec, robot, f"{arena.seats[seat].id}/", seat, len(players), rgba)
    model = spec.compile()
    data = mujoco.MjData(model)
    pose(arena, model, data, frame)
    mujoco.mj_forward(model, data)
    camera = mujoco.MjvCamera()
    camera.lookat[:] = 0, -0.08, 0
    camera.distance, camera.azimuth, camera.elevation = 2.55, 90, -47
    renderer = mujoco.Renderer(model, SIZE[1] * SCALE, SIZE[0] * SCALE)
    renderer.update_scene(data, camera)
    large = renderer.render().astype(np.float64)
    height, width = SIZE[1], SIZE[0]
    small = large.reshape(height, SCALE, width, SCALE, 3).mean(axis=(1, 3))
    return small.round().astype(np.uint8)


def pose(arena: arenas.Arena, model: mujoco.MjModel, data: mujoco.MjData, frame: Frame) -> None:
    """Put the robots where the frame has them, and show each marker in its state."""
    poses = np.frombuffer(frame.poses, "<f4")
    at = 0
    for seat in arena.seats:
        root = model.joint(f"{seat.id}/root").qposadr[0]
        data.qpos[root : root + 7] = poses[at : at + 7]
        at += 7
        joint = 0
        while mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, f"{seat.id}/j{joint}") >= 0:
            data.qpos[model.joint(f"{seat.id}/j{joint}").qposadr[0]] = poses[at]
            at, joint = at + 1, joint + 1
    states = unpack_states(frame.markers, len(arena.game.markers))
    shown = {
        f"marker:{marker.name}:{MARKER_STATES[state]}"
        for marker, state in zip(arena.game.markers, states, strict=True)
    }
    for geom in range(model.ngeom):
        name = model.geom(geom).name
        if name.startswith("marker:") and ":".join(name.split(":")[:3]) not in shown:
            model.geom_rgba[geom, 3] = 0


def png(image: npt.NDArray[np.uint8]) -> bytes:
    """Encode (height, width, 3) pixels as PNG."""
    height, width, _ = image.shape
    rows = b"".join(b"\0" + row.tobytes() for row in image)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return pack(">I", len(data)) + kind + data + pack(">I", zlib.crc32(kind + data))

    header = pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(rows, 9))
        + chunk(b"IEND", b"")
    )


if __name__ == "__main__":
    main()
