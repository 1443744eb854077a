"""The picture of a team: what is handed in with its files becomes a small square WebP."""

import io

from PIL import Image, ImageOps, UnidentifiedImageError

from lacoc_shared.messages import SentFile
from lacoc_shared.mistakes import UserError
from lacoc_shared.words import say

SIDE_PX = 192
"""Width and height of a team's picture."""
_FORMATS = ("PNG", "JPEG", "WEBP", "GIF")
_MOST_PX = 4096
"""Most pixels that a picture to read may have on either side. A small file can unpack to
gigabytes."""


def small_picture(file: SentFile) -> bytes:
    """Make a team's picture from the middle of a picture file; keep nothing else from the file.

    So the place where it was taken is lost, and so is anything hidden after the end of the picture.

    Args:
        file: a PNG, JPEG, WebP or GIF file; of an animation the first picture is used.

    Returns:
        A WebP file, `SIDE_PX` wide and high.

    Raises:
        UserError: if the file is of another kind, damaged or too large.
    """
    try:
        found = Image.open(io.BytesIO(file.data), formats=_FORMATS)
        if max(found.size) > _MOST_PX:
            raise UserError(say("desk.large-picture", name=file.name, most=_MOST_PX))
        upright = ImageOps.exif_transpose(found).convert("RGBA")
        square = ImageOps.fit(upright, (SIDE_PX, SIDE_PX))
        out = io.BytesIO()
        square.save(out, "WEBP", quality=80, method=4)
    except Image.DecompressionBombError:
        raise UserError(say("desk.large-picture", name=file.name, most=_MOST_PX)) from None
    except UnidentifiedImageError:
        raise UserError(say("desk.no-picture", name=file.name)) from None
    except (OSError, ValueError, SyntaxError, EOFError) as error:
        raise UserError(say("desk.damaged-picture", name=file.name, why=str(error))) from None
    return out.getvalue()
