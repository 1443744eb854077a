"""Takes a fingerprint of arithmetic, which explains why robots move differently on two machines.

MuJoCo calls the C library's sin, cos, exp, pow and so on. A C library chooses their code by
processor, and results may differ in the last bit. From then on the robots' paths differ too.
"""

import functools
import hashlib
import math
import platform
import struct
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import mujoco
import numpy as np

from lacoc_robots.model import set_options

BITS = ("functions", "model", "path")
"""Entries that decide whether two fingerprints match; the others describe the machine."""

_ROWS = 512
"""Number of arguments tried for each function."""
_STEPS = 200
_ONE: dict[Callable[[float], float], float] = {
    math.sin: 7.0,
    math.cos: 7.0,
    math.tan: 1.5,
    math.asin: 1.0,
    math.acos: 1.0,
    math.atan: 9.0,
    math.sinh: 5.0,
    math.cosh: 5.0,
    math.tanh: 5.0,
    math.exp: 30.0,
    math.log1p: 0.9,
}
"""Functions of one number, each with the largest absolute argument that is tried."""
_TWO: tuple[Callable[[float, float], float], ...] = (math.pow, math.atan2, math.fmod)


@functools.cache
def here() -> Mapping[str, str]:
    """Take the fingerprint of this process's arithmetic.

    Returns:
        `functions`, `model` and `path`: hashes of results of the C library's functions, of a
        compiled model, and of its state after 200 steps. `processor`, `libc`, `python` and
        `system`: names of what produced them.
    """
    model, path = _reference()
    return {
        "functions": _functions(),
        "model": model,
        "path": path,
        "processor": _processor(),
        "libc": " ".join(platform.libc_ver()).strip() or platform.system(),
        "python": platform.python_version(),
        "system": f"{sys.platform} {platform.machine()}",
    }


def same(one: Mapping[str, str], other: Mapping[str, str]) -> bool:
    """Return whether two fingerprints have the same three hashes; False if one lacks a hash."""
    return all(name in one and one[name] == other.get(name) for name in BITS)


def _functions() -> str:
    """Hash the results of the C library's functions for fixed arguments."""
    chain = hashlib.blake2b(digest_size=8)
    for function, most in _ONE.items():
        chain.update(_packed([function(most * part) for part in _parts(1)]))
    for pair in _TWO:
        rows = zip(_parts(2), _parts(3), strict=True)
        chain.update(_packed([pair(5 * abs(one) + 1e-3, 4 * other) for one, other in rows]))
    return chain.hexdigest()


def _parts(seed: int) -> list[float]:
    """Make numbers from -1 to 1 that need no rounding, so every machine makes the same ones."""
    return [((row * 2654435761 + seed * 40503) % 2**32 - 2**31) / 2**31 for row in range(_ROWS)]


def _packed(numbers: list[float]) -> bytes:
    return struct.pack(f"<{len(numbers)}d", *numbers)


def _reference() -> tuple[str, str]:
    """Compile a small model with the kinds of elements that robots have, and let it fall.

    Returns:
        A hash of the model, and a hash of its state after 200 steps.
    """
    spec = mujoco.MjSpec()
    set_options(spec)
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 0.05])
    body = spec.worldbody.add_body(name="body", pos=[0.1, 0.2, 0.12], quat=[0.9, 0.1, -0.2, 0.3])
    body.add_freejoint()
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.05, 0.07, 0.02], mass=0.4)
    for leg in range(3):
        turn = 1.1 + 2.1 * leg
        link = body.add_body(
            pos=[0.06 * math.cos(turn), 0.06 * math.sin(turn), 0], euler=[0.1, -0.2, turn]
        )
        link.add_joint(name=f"j{leg}", axis=[0.1, -1, 0.2], damping=0.01, armature=0.001)
        end = [0.08, 0.01 * leg, -0.05]
        link.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CAPSULE, fromto=[0, 0, 0, *end], size=[0.01, 0, 0], mass=0.02
        )
        servo = spec.add_actuator(target=f"j{leg}", trntype=mujoco.mjtTrn.mjTRN_JOINT)
        servo.set_to_position(kp=3.0, kv=0.1)
    model = spec.compile()
    buffer = np.empty(mujoco.mj_sizeModel(model), np.uint8)
    data = mujoco.MjData(model)
    mujoco.mj_saveModel(model, None, buffer)
    data.ctrl[:] = 0.3, -0.4, 0.5
    mujoco.mj_step(model, data, nstep=_STEPS)
    return (
        hashlib.blake2b(buffer.data, digest_size=8).hexdigest(),
        hashlib.blake2b(data.qpos.tobytes() + data.qvel.tobytes(), digest_size=8).hexdigest(),
    )


def _processor() -> str:
    """Return the model name in /proc/cpuinfo; if it has none, the name that Python knows."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
