"""The route of the rules as a text, for players who may have no internet."""

from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import BaseRoute, Route

from lacoc_client.web.gateway.cached import ASK_AGAIN
from lacoc_shared.command.documents import translated
from lacoc_shared.words import LANGUAGES

_PAGE = "rules"


def rules_route() -> BaseRoute:
    """Return the route of the rules in a language, such as /rules/ja."""

    def rules(request: Request) -> Response:
        asked = request.path_params["language"]
        language = asked if asked in LANGUAGES else LANGUAGES[0]
        text = translated(_PAGE, language).read_text("utf-8")
        headers = {"Cache-Control": ASK_AGAIN, "Content-Language": language}
        return Response(text, headers=headers, media_type="text/plain; charset=utf-8")

    return Route("/rules/{language}", rules)
