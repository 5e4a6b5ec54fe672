"""A page of black shapes and text in millimetres, as PDF and as SVG: enough for the board, no library to install."""

from __future__ import annotations

from dataclasses import dataclass, field

#: Points of PDF in a millimetre.
POINTS_PER_MM = 72.0 / 25.4
#: A circle of four Bézier curves: distance of the control points over the radius; off by 0.03 % of the radius.
_KAPPA = 0.5522847498


@dataclass(frozen=True)
class Circle:
    """Filled; centre and radius in mm, y up."""

    x: float
    y: float
    radius: float
    white: bool = False


@dataclass(frozen=True)
class Rectangle:
    """Filled; lower left corner and size in mm, y up."""

    x: float
    y: float
    width: float
    height: float
    white: bool = False


@dataclass(frozen=True)
class Text:
    """Helvetica; start of the baseline and height of the letters' em in mm, y up."""

    x: float
    y: float
    size: float
    text: str


@dataclass
class Page:
    """Shapes are drawn in their order; the origin is the lower left corner."""

    width_mm: float
    height_mm: float
    title: str
    shapes: list[Circle | Rectangle | Text] = field(default_factory=list)

    def pdf(self) -> bytes:
        """PDF 1.4 of one page at true scale; its content stream is in mm after one scaling."""
        content = [f"{POINTS_PER_MM:.9f} 0 0 {POINTS_PER_MM:.9f} 0 0 cm"]
        for shape in self.shapes:
            content += _pdf(shape)
        stream = "\n".join(content).encode("latin-1")
        box = f"0 0 {self.width_mm * POINTS_PER_MM:.4f} {self.height_mm * POINTS_PER_MM:.4f}"
        fonts = "/Resources << /Font << /F 5 0 R >> >>"
        objects = [
            # Viewers that heed it do not fit the page to the paper.
            b"<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
            b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
            f"<< /Type /Page /Parent 2 0 R /MediaBox [{box}] /Contents 4 0 R {fonts} >>".encode(),
            f"<< /Length {len(stream)} >>\nstream\n".encode() + stream + b"\nendstream",
            b"<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
            f"<< /Title ({_escaped(self.title)}) >>".encode("latin-1"),
        ]
        out, offsets = b"%PDF-1.4\n", []
        for number, body in enumerate(objects, start=1):
            offsets.append(len(out))
            out += f"{number} 0 obj\n".encode() + body + b"\nendobj\n"
        table = f"xref\n0 {len(objects) + 1}\n0000000000 65535 f \n" + "".join(f"{o:010d} 00000 n \n" for o in offsets)
        trailer = f"trailer\n<< /Size {len(objects) + 1} /Root 1 0 R /Info 6 0 R >>\nstartxref\n{len(out)}\n%%EOF\n"
        return out + table.encode() + trailer.encode()

    def svg(self) -> str:
        """SVG with its size in mm and user units of one mm."""
        lines = [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.width_mm}mm" height="{self.height_mm}mm" '
            f'viewBox="0 0 {self.width_mm} {self.height_mm}">',
            f"<title>{_escaped_xml(self.title)}</title>",
            f'<rect width="{self.width_mm}" height="{self.height_mm}" fill="white"/>',
        ]
        lines += [_svg(shape, self.height_mm) for shape in self.shapes]
        return "\n".join([*lines, "</svg>"]) + "\n"


def _number(value: float) -> str:
    return f"{value:.5f}".rstrip("0").rstrip(".")


def _pdf(shape: Circle | Rectangle | Text) -> list[str]:
    n = _number
    if isinstance(shape, Rectangle):
        return [f"{1 if shape.white else 0} g {n(shape.x)} {n(shape.y)} {n(shape.width)} {n(shape.height)} re f"]
    if isinstance(shape, Text):
        return [f"0 g BT /F {n(shape.size)} Tf {n(shape.x)} {n(shape.y)} Td ({_escaped(shape.text)}) Tj ET"]
    x, y, r, k = shape.x, shape.y, shape.radius, _KAPPA * shape.radius
    corners = [(x + r, y, 0, 1), (x, y + r, -1, 0), (x - r, y, 0, -1), (x, y - r, 1, 0)]
    lines = [f"{1 if shape.white else 0} g {n(corners[0][0])} {n(corners[0][1])} m"]
    for (ax, ay, au, av), (bx, by, bu, bv) in zip(corners, corners[1:] + corners[:1]):
        points = (ax + k * au, ay + k * av, bx - k * bu, by - k * bv, bx, by)
        lines.append(" ".join(map(n, points)) + " c")
    return [*lines, "f"]


def _svg(shape: Circle | Rectangle | Text, height_mm: float) -> str:
    n = _number
    if isinstance(shape, Rectangle):
        top = height_mm - shape.y - shape.height
        size = f'width="{n(shape.width)}" height="{n(shape.height)}"'
        return f'<rect x="{n(shape.x)}" y="{n(top)}" {size}{_fill(shape.white)}/>'
    if isinstance(shape, Text):
        place = f'x="{n(shape.x)}" y="{n(height_mm - shape.y)}" font-size="{n(shape.size)}"'
        return f'<text {place} font-family="Helvetica, Arial, sans-serif">{_escaped_xml(shape.text)}</text>'
    return f'<circle cx="{n(shape.x)}" cy="{n(height_mm - shape.y)}" r="{n(shape.radius)}"{_fill(shape.white)}/>'


def _fill(white: bool) -> str:
    return ' fill="white"' if white else ""


def _escaped(text: str) -> str:
    return text.replace("\\", r"\\").replace("(", r"\(").replace(")", r"\)")


def _escaped_xml(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


__all__ = ["POINTS_PER_MM", "Circle", "Page", "Rectangle", "Text"]
