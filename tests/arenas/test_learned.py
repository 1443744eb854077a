"""Learned policies: layers that fit, the same keys after an export, and clear errors."""

import importlib.util
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lacoc_arenas import arena as arenas
from lacoc_arenas import brains
from lacoc_arenas.learned.network import Layer, Network, export, read
from lacoc_arenas.learned.senses import partners
from lacoc_shared.mistakes import UserError


def some(inputs: int, hidden: list[int], keys: tuple[int, ...], seed: int) -> Network:
    chance = np.random.default_rng(seed)
    sizes = [inputs, *hidden, len(keys)]
    layers = [
        Layer(chance.normal(size=(after, before)), chance.normal(size=after))
        for before, after in pairwise(sizes)
    ]
    return Network(layers, keys, every_ticks=3, activation="relu" if seed % 2 else "tanh")


@given(
    inputs=st.integers(1, 40),
    hidden=st.lists(st.integers(1, 9), max_size=2),
    keys=st.lists(st.sampled_from([0, 1, 2, 3, 10]), min_size=1, max_size=5, unique=True),
    seed=st.integers(0, 99),
)
def test_an_exported_policy_is_the_same(
    inputs: int, hidden: list[int], keys: list[int], seed: int
) -> None:
    """A policy that was written and read again presses the same keys."""
    network = some(inputs, hidden, tuple(keys), seed)
    text = export(network).split('"""')[3]
    again = read(text)
    assert (again.keys, again.every_ticks, again.activation) == (
        network.keys,
        network.every_ticks,
        network.activation,
    )
    for one, other in zip(network.layers, again.layers, strict=True):
        assert one.weights.tobytes() == other.weights.tobytes()
        assert one.biases.tobytes() == other.biases.tobytes()
    numbers = np.random.default_rng(seed + 1).normal(size=inputs).astype(np.float32)
    assert again.choose(numbers) == network.choose(numbers)


def test_the_file_is_a_bot(tmp_path: Path) -> None:
    """The text that `export` returns is a bot file.

    If a game gives a bot another number of inputs than the bot learned with, the bot's error names
    the number that it learned with.
    """
    file = tmp_path / "my_bot.py"
    file.write_text(export(some(7, [3], (1, 2), 0)), encoding="utf-8")
    spec = importlib.util.spec_from_file_location("my_bot", file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert module.NETWORK.inputs == 7
    bot = brains.find(arenas.load("othello"), str(file))

    class Seat:
        legs = ("RF", "LF")

    class Sheet:
        arena = "othello"
        duration_s = 10.0
        seats = (Seat(), Seat())
        markers = ()

    with pytest.raises(UserError, match="7 numbers"):
        bot(Sheet(), 0)  # type: ignore[arg-type]


ONE = np.ones(1)
TWO = np.ones((2, 3))


@pytest.mark.parametrize(
    ("layers", "keys", "said"),
    [
        ([], (1,), "layers"),
        ([Layer(TWO, np.ones(2))], (1,), "2 outputs for 1 keys"),
        ([Layer(TWO, ONE)], (1, 2), "layers"),
        ([Layer(TWO, np.ones(2)), Layer(TWO, np.ones(2))], (1, 2), "layers"),
        ([Layer(TWO * np.nan, np.ones(2))], (1, 2), "finite"),
    ],
)
def test_layers_that_do_not_fit(layers: Any, keys: tuple[int, ...], said: str) -> None:
    """Layers that do not fit each other or the keys are refused with a sentence."""
    with pytest.raises(UserError, match=said):
        Network(layers, keys)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        *(
            ({"keys": keys}, "keys are .* from 0 to 9, or 10")
            for keys in ((1, 12), (1, -3), (1.5, 2), (2, 2), 5, ("1", "2"))
        ),
        *(({"every_ticks": ticks}, "every_ticks is .* at least 1") for ticks in (0, -1, 2.5, "3")),
        ({"activation": "gelu"}, "activation is 'gelu'; it can be"),
    ],
)
def test_wrong_arguments_of_a_policy(wrong: dict[str, Any], said: str) -> None:
    """Keys, ticks or an activation that a bot could not use are refused as a policy is made."""
    with pytest.raises(UserError, match=said):
        Network(**{"layers": [Layer(TWO, np.ones(2))], "keys": (1, 2), **wrong})


def test_numbers_of_numpy_can_be_exported() -> None:
    """A policy whose numbers come from numpy can be exported."""
    layers = [Layer(TWO, np.ones(2))]
    network = Network(layers, np.array([1, 2]), every_ticks=np.int64(72))  # type: ignore[arg-type]
    again = read(export(network).split('"""')[3])
    assert (again.keys, again.every_ticks) == ((1, 2), 72)


@pytest.mark.parametrize("text", ["", "!!", "abcde", "<tnB"])
def test_damaged_text(text: str) -> None:
    """The text of a damaged file is refused with a sentence."""
    with pytest.raises(UserError, match="damaged"):
        read(text)


@pytest.mark.parametrize("arena", ["othello", "flag-strike"])
def test_each_marker_has_a_partner(arena: str) -> None:
    """`partners` finds the marker opposite each marker, or returns None if a marker is missing."""
    markers = arenas.load(arena).game.markers
    found = partners(markers)
    assert found is not None
    assert all(found[found[index]] == index != found[index] for index in range(len(markers)))
    assert partners(markers[1:]) is None
