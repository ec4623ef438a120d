"""The XML level of SVG and OPX files."""

from __future__ import annotations

from xml.etree import ElementTree

from exactfold.errors import MalformedDrawingError


def xml_root(text: str) -> ElementTree.Element:
    """The outermost element of an XML text; raises `MalformedDrawingError` with the place.

    Nothing is fetched from outside, and expat limits the growth of entities.
    """
    try:
        return ElementTree.fromstring(text)
    except (ElementTree.ParseError, ValueError) as error:
        raise MalformedDrawingError(f"not XML: {error}") from None
