"""A learned policy (a neural network) as layers of numbers, and as a bot file.

A bot file holds the layers as text. To play, it needs neither MuJoCo nor the library that trained
the policy.
"""

import base64
import textwrap
import zlib
from collections.abc import Sequence
from typing import Literal, NamedTuple, get_args

import msgspec
import numpy as np
import numpy.typing as npt

from lacoc_arenas.bot import Brain, Key
from lacoc_arenas.learned.arguments import short, whole
from lacoc_arenas.learned.senses import Numbers, Senses
from lacoc_shared.gait.tables import Level
from lacoc_shared.messages import Frame, Sheet
from lacoc_shared.mistakes import UserError
from lacoc_shared.seat import RESTART_KEY
from lacoc_shared.words import say

Activation = Literal["tanh", "relu"]

_FILE = '''\
"""A bot that a machine learned; written by `lacoc_arenas.learned.network.export`."""

from lacoc_arenas.learned.network import read

NETWORK = read(
    """
{text}
    """
)


def bot(sheet, seat):
    return NETWORK.brain(sheet, seat)
'''


class Layer(NamedTuple):
    """One layer of a policy: its output is `weights @ input + biases`."""

    weights: npt.NDArray[np.float64]
    """Shape (outputs, inputs)."""
    biases: npt.NDArray[np.float64]
    """Shape (outputs,)."""

    def __repr__(self) -> str:
        return f"Layer(weights={np.shape(self.weights)}, biases={np.shape(self.biases)})"


class _SavedNetwork(msgspec.Struct, frozen=True, array_like=True):
    keys: tuple[int, ...]
    inputs: int
    every_ticks: int
    activation: Activation
    shapes: tuple[tuple[int, int], ...]
    numbers: bytes


class Network:
    """A policy that presses the key of its largest output.

    Args:
        layers: all layers, beginning at the input. The first takes the numbers of `Senses`; the
            last has one output for each key.
        keys: digits of level B, and `RESTART_KEY` for [x]; each at most once.
        every_ticks: the policy chooses a key in every n-th tick, as it did with `beats` = n in an
            environment.
        activation: the function that follows each layer but the last.

    Raises:
        UserError: if the layers do not fit each other or the keys, or another argument is wrong.
    """

    def __init__(
        self,
        layers: Sequence[Layer],
        keys: Sequence[int],
        every_ticks: int = 1,
        activation: Activation = "tanh",
    ) -> None:
        self.layers = [Layer(*(np.asarray(part, np.float64) for part in one)) for one in layers]
        self.keys = _digits(keys)
        self.every_ticks = whole("every_ticks", every_ticks, 1)
        if activation not in get_args(Activation):
            raise UserError(say("learned.activation", found=short(activation)))
        self.activation: Activation = activation
        shapes = [layer.weights.shape for layer in self.layers]
        fits = all(
            len(shape) == 2 and layer.biases.shape == shape[:1]
            for shape, layer in zip(shapes, self.layers, strict=True)
        )
        ends = [shape[0] for shape in shapes[:-1]] if fits else []
        if not (shapes and fits and ends == [s[1] for s in shapes[1:]]):
            raise UserError(say("learned.layers", shapes=str(shapes)))
        if shapes[-1][0] != len(self.keys):
            raise UserError(say("learned.keys", outputs=shapes[-1][0], keys=len(self.keys)))
        if not all(np.isfinite(part).all() for layer in self.layers for part in layer):
            raise UserError(say("learned.not-finite"))

    @property
    def inputs(self) -> int:
        """How many numbers the policy takes at a time."""
        return int(self.layers[0].weights.shape[1])

    def choose(self, numbers: Numbers) -> int:
        """Return the index in `keys` of the key to press; in an environment it is the action."""
        values = numbers.astype(np.float64)
        for index, layer in enumerate(self.layers):
            if index:
                values = np.tanh(values) if self.activation == "tanh" else np.maximum(values, 0)
            values = layer.weights @ values + layer.biases
        return int(values.argmax())

    def brain(self, sheet: Sheet, seat: int) -> Brain:
        """Make a brain that plays the policy in one match.

        Raises:
            UserError: if a frame of this match gives more or fewer numbers than the policy takes.
        """
        senses = Senses(sheet)
        if senses.size != self.inputs:
            raise UserError(
                say(
                    "learned.other-match", learned=self.inputs, found=senses.size, arena=sheet.arena
                )
            )

        def see(frame: Frame) -> Key | None:
            if (frame.clock_ticks - 1) % self.every_ticks:
                return None
            return press(frame, seat, self.keys[self.choose(senses.see(frame, seat))])

        return see


def _digits(keys: Sequence[int]) -> tuple[int, ...]:
    """Return keys as digits, after a check that there is at least one and none comes twice."""
    try:
        digits = tuple(whole("keys", key, 0, RESTART_KEY) for key in keys)
    except (TypeError, UserError):
        digits = ()
    if not digits or len(set(digits)) != len(digits):
        raise UserError(say("learned.digits", found=short(keys), restart=RESTART_KEY))
    return digits


def press(frame: Frame, seat: int, digit: int) -> Key | None:
    """Return the key to press, so that `digit` becomes the digit of the seat's present key.

    None if it is this already (never for [x]), or if the seat's keys are refused now.
    """
    now = frame.seats[seat]
    if now.locked_ticks or (digit == now.key and now.level == Level.LOCOMOTION):
        return None
    return Key(Level.LOCOMOTION, digit)


def export(network: Network) -> str:
    """Return the text of a bot file that plays this policy."""
    parts = [part for layer in network.layers for part in layer]
    saved = _SavedNetwork(
        network.keys,
        network.inputs,
        network.every_ticks,
        network.activation,
        tuple((layer.weights.shape[0], layer.weights.shape[1]) for layer in network.layers),
        b"".join(part.astype("<f8").tobytes() for part in parts),
    )
    packed = base64.b85encode(zlib.compress(msgspec.msgpack.encode(saved), 9)).decode()
    return _FILE.format(text=textwrap.fill(packed, 96, break_on_hyphens=False))


def read(text: str) -> Network:
    """Read the policy from the text of a bot file.

    Raises:
        UserError: if the text is damaged, or its layers do not fit.
    """
    try:
        packed = base64.b85decode("".join(text.split()))
        saved = msgspec.msgpack.decode(zlib.decompress(packed), type=_SavedNetwork)
        layers, at = [], 0
        numbers = np.frombuffer(saved.numbers, "<f8")
        for outputs, inputs in saved.shapes:
            weights = numbers[at : at + outputs * inputs].reshape(outputs, inputs)
            at += outputs * inputs
            layers.append(Layer(weights, numbers[at : at + outputs]))
            at += outputs
    except (ValueError, zlib.error, msgspec.MsgspecError) as error:
        raise UserError(say("learned.damaged", error=str(error)[:80])) from None
    return Network(layers, saved.keys, saved.every_ticks, saved.activation)


__all__ = ["RESTART_KEY", "Layer", "Network", "export", "press", "read"]
