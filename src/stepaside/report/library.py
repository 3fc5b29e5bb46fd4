"""The library that draws pages from disk: three.js, as trimesh brings it.

Its text goes into the page, which needs no network then. It is under the MIT
licence, whose notice is the text's own first lines.
"""

import io
import zipfile
from functools import cache

from ..errors import ConfigurationError

ARCHIVE = "templates/viewer.zip"  # of trimesh
TEMPLATE = "viewer.html.template"
BEGIN = "/**\n * @license\n * Copyright 2010-"  # notice of three.js
END = 'Object.defineProperty(t,"__esModule",{value:!0})}));'


@cache
def three() -> str:
    """Text of three.js, which gives a page the name ``THREE``.

    Raises:
        ConfigurationError: If trimesh is not there, or brings it no more.
    """
    try:
        from trimesh.resources import get_bytes

        with zipfile.ZipFile(io.BytesIO(get_bytes(ARCHIVE))) as archive:
            text = archive.read(TEMPLATE).decode("utf-8")
        begin = text.index(BEGIN)
        end = text.index(END, begin) + len(END)
    except ImportError as error:
        raise ConfigurationError(
            "pages need three.js, which comes with trimesh: "
            "pip install 'stepaside[viewer]'"
        ) from error
    except (KeyError, OSError, ValueError, zipfile.BadZipFile) as error:
        raise ConfigurationError(
            "pages need a trimesh that brings three.js, as 4.0 to 5.2 do"
        ) from error
    return text[begin:end]
