"""Installs what a release ships into clean environments and tries it.

    python tests/project/wheel_smoke.py dist

The wheel is installed without MuJoCo, as on a contestant's machine. The source archive is installed
with MuJoCo, as on a court's machine.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
import urllib.request
import venv
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

_LIMIT_S = 300  # longer than any command needs, unless it hangs
README = "import importlib.metadata as m; print(m.metadata('lacoc').get_payload())"
IMPORT_ALL = """
import importlib, pkgutil
SIMULATE = "lacoc_server.simulate."
EXTRAS = "lacoc_client.film", SIMULATE + "environments", SIMULATE + "registering"
def failed(name):
    if not name.startswith(EXTRAS):
        raise
for name in {packages}:
    package = importlib.import_module(name)
    for module in pkgutil.walk_packages(package.__path__, name + ".", failed):
        if not module.name.endswith("__main__") and not module.name.startswith(EXTRAS):
            importlib.import_module(module.name)
"""
"""Imports all modules but those of extras that are not installed."""


class Environment:
    """A virtual environment with one archive installed."""

    def __init__(self, folder: Path, archive: Path, extra: str = "") -> None:
        venv.create(folder, with_pip=True)
        self.bin = folder / ("Scripts" if os.name == "nt" else "bin")
        self.folder = folder
        self.run("python", "-m", "pip", "install", "--quiet", f"{archive.resolve()}{extra}")

    def run(self, *command: str, code: int = 0) -> subprocess.CompletedProcess[str]:
        """Run a program of the environment outside the checkout; stop if its exit code is wrong."""
        done = subprocess.run(
            [str(self.bin / command[0]), *command[1:]],
            cwd=self.folder,
            capture_output=True,
            text=True,
            check=False,
            timeout=_LIMIT_S,
        )
        if done.returncode != code:
            sys.exit(
                f"{' '.join(command)}: exit code {done.returncode}, expected {code}\n"
                f"{done.stdout}{done.stderr}"
            )
        return done


def try_pages(env: Environment) -> None:
    """Check that the gateway serves the installed pages on a machine without Node."""
    command = [str(env.bin / "lacoc"), "web", "--json", "--connect", "tcp/127.0.0.1:1"]
    with subprocess.Popen(
        command, cwd=env.folder, env={**os.environ, "PATH": str(env.bin)}, stdout=subprocess.PIPE
    ) as gateway:
        try:
            assert gateway.stdout is not None
            url = json.loads(gateway.stdout.readline())["url"]
            page = fetch(f"{url}/watch")
            scripts = re.findall(r'src="\./(assets/[^"]+)"', page)
            assert scripts, page
            assert all(fetch(f"{url}/{script}") for script in scripts)
        finally:
            gateway.terminate()


def fetch(url: str) -> str:
    """Return the text that a gateway sends for an address."""
    with urllib.request.urlopen(url, timeout=_LIMIT_S) as response:
        text: str = response.read().decode()
        return text


def try_docs(env: Environment) -> None:
    """Check that pages can be read, and that the metadata names no file that is not there."""
    assert env.run("lacoc", "docs", "contest").stdout.startswith("# The contest")
    readme = env.run("python", "-c", README).stdout
    assert "# LACOC" in readme
    assert not re.findall(r"\]\((?!https?://)[^)]*\)", readme), readme


def try_both(env: Environment) -> None:
    """Try the commands that must work both with and without MuJoCo."""
    try_pages(env)
    env.run("lacoc", "--version")
    assert "practice" in env.run("lacoc", "--help").stdout
    env.run("lacoc", "gait", "sample", "gaits")
    env.run("lacoc", "gait", "check", str(Path("gaits", "Loco-data.xlsx")))
    try_docs(env)
    env.run("lacoc", "contest", "init")
    env.run("lacoc", "contest", "check")


def try_contestant(env: Environment, archive: Path) -> None:
    """Try a contestant's machine: MuJoCo is missing, and `serve` says in a line what to install."""
    try_both(env)
    env.run("python", "-c", IMPORT_ALL.format(packages=["lacoc", "lacoc_shared", "lacoc_client"]))
    error = env.run("lacoc", "serve", "--arena", "othello", code=2).stderr
    assert error.count("\n") == 1, error
    assert f"{archive.resolve()}[server]" in error, error
    error = env.run("lacoc", "film", "a.mcap", "a.mp4", code=2).stderr
    assert f"{archive.resolve()}[film]" in error, error
    error = env.run("lacoc", "contest", "certificate", code=2).stderr
    assert re.search(r"Needs cryptography.*\[server\]", error), error
    shown = " ".join(env.run("lacoc", "--help").stdout.split())
    assert "practice Walk your robot on a field of its own" in shown, shown
    assert '(needs the extra "server")' in shown, shown
    checked = json.loads(env.run("lacoc", "doctor", "--json", "--seconds", "0.2").stdout)
    assert [one["about"] for one in checked if "run a court" in one["found"]] == [
        "packages of a court"
    ], checked


def try_court(env: Environment) -> None:
    """Try a court's machine: every module can be imported, and a short match can be played."""
    try_both(env)
    packages = ["lacoc_shared", "lacoc_robots", "lacoc_arenas", "lacoc_server", "lacoc_client"]
    walk = "import lacoc; print(lacoc.walk('gaits/Loco-data.xlsx'))"
    assert env.run("python", "-c", walk).stdout.startswith("speed forward")
    env.run("python", "-c", IMPORT_ALL.format(packages=packages))
    env.run("lacoc", "contest", "certificate")
    env.run("lacoc", "contest", "enter", "Bees")
    invited = env.run("lacoc", "contest", "invite").stdout
    assert re.search(r"https://\S+/play#token=[a-z2-7]+&authority=[0-9a-f]{64}", invited), invited
    env.run("lacoc", "demo", "--headless", "--seconds", "3")


def main(dist: Path) -> None:
    """Try the one wheel and the one source archive in the folder `dist`."""
    (wheel,) = dist.glob("*.whl")
    (source,) = dist.glob("*.tar.gz")
    with (
        tempfile.TemporaryDirectory(prefix="lacoc smoke ") as folder,
        ThreadPoolExecutor() as aside,
    ):
        # Both at once: an installation mostly waits for the network.
        installed = [
            aside.submit(Environment, Path(folder, "contestant"), wheel),
            aside.submit(Environment, Path(folder, "court"), source, "[server]"),
        ]
        try_contestant(installed[0].result(), wheel)
        print(f"{wheel.name}: a contestant's machine works")
        try_court(installed[1].result())
        print(f"{source.name}: a court's machine works")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
