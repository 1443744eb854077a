"""How to install what is missing, from where LACOC came."""

import json
import re
import shlex
import sys
from importlib.metadata import Distribution, PathDistribution
from pathlib import Path
from typing import Any

import pytest

from lacoc_shared.command import installing

METADATA = """Metadata-Version: 2.4
Name: lacoc
Version: 0.1.0
Requires-Dist: rich>=13.7
Requires-Dist: cmaes>=0.13; extra == 'server'
Requires-Dist: mujoco<4,>=3.17; extra == 'server'
Requires-Dist: av<19,>=18; extra == 'film'
"""


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Give a function that pretends that LACOC was installed with this direct_url.json."""

    def install(origin: dict[str, Any] | str | None) -> None:
        folder = tmp_path / "lacoc-0.1.0.dist-info"
        folder.mkdir(exist_ok=True)
        (folder / "METADATA").write_text(METADATA)
        if origin is not None:
            text = origin if isinstance(origin, str) else json.dumps(origin)
            (folder / "direct_url.json").write_text(text)
        found: Distribution = PathDistribution(folder)
        monkeypatch.setattr(installing, "distribution", lambda name: found)

    return install


def wanted(*extras: str) -> list[str]:
    """Return what the advice gives to pip, after its word "install"."""
    words = shlex.split(installing.command(*extras))
    return words[words.index("install") + 1 :]


@pytest.mark.skipif(sys.platform == "win32", reason="paths and quotes of POSIX")
@pytest.mark.parametrize(
    ("origin", "expected"),
    [
        ({"url": "file://{here}", "dir_info": {}}, ["{here}[server,film]"]),
        (
            {"url": "file://{here}", "dir_info": {"editable": True}},
            ["--editable", "{here}[server,film]"],
        ),
        ({"url": "file://{here}/a%20b.whl", "archive_info": {}}, ["{here}/a b.whl[server,film]"]),
        (
            {"url": "https://example.org/lacoc.whl", "archive_info": {}},
            ["lacoc[server,film] @ https://example.org/lacoc.whl"],
        ),
        (
            {"url": "https://example.org/x", "vcs_info": {"vcs": "git", "commit_id": "abc"}},
            ["lacoc[server,film] @ git+https://example.org/x@abc"],
        ),
    ],
)
def test_an_extra_comes_from_where_lacoc_came(
    installed: Any, tmp_path: Path, origin: dict[str, Any], expected: list[str]
) -> None:
    """A folder, a wheel, an address and a repository are named again, with the extras."""
    (tmp_path / "a b.whl").touch()
    installed({**origin, "url": origin["url"].replace("{here}", str(tmp_path))})

    assert wanted("server", "film") == [one.replace("{here}", str(tmp_path)) for one in expected]


@pytest.mark.parametrize(
    "origin", [None, {"url": "file:///no/such/wheel.whl", "archive_info": {}}, "{", '{"url": 1}']
)
def test_without_such_a_place_the_packages_are_named(
    installed: Any, origin: dict[str, Any] | str | None
) -> None:
    """If nobody knows where LACOC came from, or it is gone, the extra's packages are named."""
    installed(origin)

    assert wanted("server") == ["cmaes>=0.13", "mujoco<4,>=3.17"]
    assert wanted("server", "film") == ["cmaes>=0.13", "mujoco<4,>=3.17", "av<19,>=18"]


def test_the_installer_is_that_of_this_environment(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """`pip` alone is advised only where the shell finds this environment's."""
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    pip = tmp_path / "pip"
    pip.touch(mode=0o755)
    monkeypatch.setenv("PATH", "")
    assert shlex.split(installing.of("x")) == [sys.executable, "-m", "pip", "install", "x"]

    monkeypatch.setattr(installing.shutil, "which", lambda name: str(pip))
    assert installing.of("x") == "pip install x"

    monkeypatch.setattr(installing, "find_spec", lambda name: None)
    assert installing.of("x").startswith("uv pip install --python ")


def test_each_module_is_of_an_extra_that_has_its_package() -> None:
    """The extras of the modules are those of pyproject.toml."""
    import tomllib

    project = tomllib.loads(Path(__file__).parents[2].joinpath("pyproject.toml").read_text())
    for module, extra in installing.EXTRA_OF.items():
        packages = project["project"]["optional-dependencies"][extra]
        assert module in {re.split(r"[^\w-]", package)[0] for package in packages}
