"""`lacoc contest`: its subcommands in the order in which an organiser needs them."""

import typer

from lacoc_server.commands.contest import (
    checking,
    deciding,
    elsewhere,
    inviting,
    playing,
    setting_up,
    standby,
    steering,
)

app = typer.Typer(
    help="Run a contest: its file, courts and tokens; entries, matches, standings and their proof.",
    no_args_is_help=True,
)
for command in (
    setting_up.init,
    setting_up.check,
    setting_up.certificate,
    playing.enter,
    inviting.invite,
    deciding.withdraw,
    playing.run,
    elsewhere.courts,
    standby.standby,
    playing.standings,
    deciding.draw,
    steering.undraw,
    deciding.decide,
    steering.move,
    steering.pause,
    steering.resume,
    steering.shift,
    steering.unshift,
    steering.announce,
    steering.substitute,
    steering.staff,
    checking.publish,
    checking.verify,
):
    app.command()(command)
