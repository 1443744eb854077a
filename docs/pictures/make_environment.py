"""Write docs/pictures/environment.png: what `render` of an environment returns.

Run it from the checkout: python docs/pictures/make_environment.py
"""

from pathlib import Path

from make_match import png

from lacoc_server.simulate.environments import LacocParallelEnv


def main() -> None:
    """Play 22 s of Robot-Othello and write the picture."""
    env = LacocParallelEnv("othello", render_mode="rgb_array", beats=50)
    env.reset(options={"place": 0, "late_ticks": (0, 0)})
    for second in range(22):
        env.step({"left": 2, "right": 2 if second < 16 else 1})
    picture = env.render()
    env.close()
    assert picture is not None
    Path(__file__).with_name("environment.png").write_bytes(png(picture))


if __name__ == "__main__":
    main()
