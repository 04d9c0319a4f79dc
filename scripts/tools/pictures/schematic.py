"""Circuit diagrams as SVG: wires, parts and labels on a plane of pixels. Readable in light and in dark mode, and printed."""
import html

STYLE = """
    .back { fill: #ffffff } .ink { stroke: #1b2733; stroke-width: 1.6; fill: none; stroke-linejoin: round; stroke-linecap: round }
    .part { stroke: #1b2733; stroke-width: 1.6; fill: #eef3f8 } .dot, .full { fill: #1b2733 }
    .board { stroke: #b36b00; stroke-width: 2; fill: #fff3d6 } .bus { stroke: #1b2733; stroke-width: 4 }
    .box { stroke: #8a97a3; stroke-width: 1.2; stroke-dasharray: 6 4; fill: none }
    text { fill: #1b2733; font-size: 13px } .small { font-size: 11.5px; fill: #44525f } .bold { font-weight: bold }
    .title { font-size: 16px; font-weight: bold }
    @media (prefers-color-scheme: dark) {
      .back { fill: #10161c } .ink, .part, .bus { stroke: #dfe7ee } .part { fill: #1e2a35 } .dot, .full { fill: #dfe7ee }
      .board { stroke: #e0a040; fill: #33270f } .box { stroke: #77858f } text { fill: #e8eef3 } .small { fill: #b4c0ca }
    }
    @media print {
      .back { fill: #ffffff } .ink, .part, .bus { stroke: #000000 } .part { fill: #ffffff } .dot, .full { fill: #000000 }
      .board { stroke: #000000; fill: #ffffff } text, .small { fill: #000000 }
    }"""


class Drawing:
    """Each method draws one thing and gives nothing back. Coordinates are those of the end of a lead, not of the middle."""

    def __init__(self, width, height, title):
        self.width, self.height, self.title, self.parts = width, height, title, []

    def add(self, text):
        self.parts.append("  " + text)

    def text(self, x, y, words, kind="", anchor="start"):
        self.add(f'<text x="{x}" y="{y}" class="{kind}" text-anchor="{anchor}">{html.escape(words)}</text>')

    def path(self, data, kind="ink"):
        self.add(f'<path d="{data}" class="{kind}"/>')

    def wire(self, *points):
        self.path("M" + " L".join(f"{x} {y}" for x, y in points))

    def dot(self, x, y):
        self.add(f'<circle cx="{x}" cy="{y}" r="3.2" class="dot"/>')

    def rectangle(self, x, y, width, height, kind="part"):
        self.add(f'<rect x="{x}" y="{y}" width="{width}" height="{height}" rx="3" class="{kind}"/>')

    def ground(self, x, y):
        self.path(f"M{x} {y} v8 M{x - 9} {y + 8} h18 M{x - 5} {y + 12} h10 M{x - 2} {y + 16} h4")

    def rail(self, x, y, words):
        """A supply rail above this point."""
        self.path(f"M{x} {y} v-8 M{x - 8} {y - 8} h16")
        self.text(x, y - 13, words, "small", "middle")

    def upright(self, x, y, length, symbol, words, side=1):
        """A part in a vertical wire: its symbol is 26 high, and is drawn from the origin of its own plane downwards."""
        above = (length - 26) // 2
        self.path(f"M{x} {y} v{above} M{x} {y + above + 26} v{length - above - 26}")
        self.add(f'<g transform="translate({x} {y + above})">{symbol}</g>')
        self.words(x + side * 14, y + above + 12, words, "start" if side > 0 else "end")

    def words(self, x, y, words, anchor="start"):
        """Name, and below it the part."""
        for index, line in enumerate(words.split("|")):
            self.text(x, y + 14 * index, line, "small" if index else "", anchor)

    RESISTOR = '<rect x="-6" y="0" width="12" height="26" class="part"/>'
    CAPACITOR = '<path d="M0 0 v10 M-9 10 h18 M-9 16 h18 M0 16 v10" class="ink"/>'
    DIODE_UP = '<path d="M0 0 v6 M-8 6 h16 M0 20 v6" class="ink"/><path d="M0 6 l-8 14 h16 z" class="full"/>'
    DIODE_DOWN = '<path d="M0 0 v6 M0 20 v6 M-8 20 h16" class="ink"/><path d="M0 20 l-8 -14 h16 z" class="full"/>'
    TVS = ('<path d="M0 0 v4 M0 22 v4 M-9 16 l3 -3 h12 l3 -3" class="ink"/>'
           '<path d="M0 13 l-7 -9 h14 z M0 13 l-7 9 h14 z" class="full"/>')
    COIL = '<rect x="-13" y="3" width="26" height="20" class="part"/><path d="M-13 23 L13 3 M0 0 v3 M0 23 v3" class="ink"/>'

    def resistor(self, x, y, length, words, side=1):
        self.upright(x, y, length, self.RESISTOR, words, side)

    def capacitor(self, x, y, length, words, side=1):
        self.upright(x, y, length, self.CAPACITOR, words, side)

    def diode(self, x, y, length, words, side=1, up=True):
        self.upright(x, y, length, self.DIODE_UP if up else self.DIODE_DOWN, words, side)

    def tvs(self, x, y, length, words, side=1):
        self.upright(x, y, length, self.TVS, words, side)

    def coil(self, x, y, length, words, side=1):
        self.upright(x, y, length, self.COIL, words, side)

    def lying(self, x, y, length, symbol, words, below=False):
        """The same in a horizontal wire, from left to right."""
        before = (length - 26) // 2
        self.path(f"M{x} {y} h{before} M{x + before + 26} {y} h{length - before - 26}")
        self.add(f'<g transform="translate({x + before} {y}) rotate(-90)">{symbol}</g>')
        lines = words.split("|")
        top = y + 26 if below else y - 14 - 14 * (len(lines) - 1)
        for index, line in enumerate(lines):
            self.text(x + length // 2, top + 14 * index, line, "small" if index else "", "middle")

    def fuse(self, x, y, length, words):
        before = (length - 34) // 2
        self.path(f"M{x} {y} h{length}")
        self.add(f'<rect x="{x + before}" y="{y - 7}" width="34" height="14" rx="2" class="ink"/>')
        self.text(x + length // 2, y - 14, words, "", "middle")

    def contact(self, x, y, length, words, closed=False, pins=("", ""), below=False):
        """A contact in a horizontal wire, as it is without current or when nobody presses."""
        start = x + (length - 34) // 2
        end = start + 34
        self.path(f"M{x} {y} H{start} M{end} {y} H{x + length}")
        if closed:
            self.path(f"M{start} {y} L{end + 2} {y - 13} M{end} {y} v-16")
        else:
            self.path(f"M{start} {y} L{end - 2} {y - 15}")
        self.text(start - 3, y + 14, pins[0], "small", "end")
        self.text(end + 3, y + 14, pins[1], "small")
        self.text((start + end) // 2, y + 30 if below else y - 24, words, "", "middle")

    def transistor(self, x, y, words):
        """N-channel MOSFET: gate at (x, y), drain at (x + 34, y - 30), source at (x + 34, y + 30)."""
        self.path(f"M{x} {y} h14 M{x + 14} {y - 14} v28 M{x + 20} {y - 17} v10 M{x + 20} {y - 5} v10 M{x + 20} {y + 7} v10")
        self.path(f"M{x + 20} {y - 12} h14 v-18 M{x + 20} {y + 12} h14 v18 M{x + 34} {y + 12} v-12 h-14")
        self.path(f"M{x + 20} {y} l8 -4 v8 z", "full")
        self.words(x + 42, y + 4, words)

    def coupler(self, x, y, words):
        """Optocoupler of 90 x 60: anode (x, y + 14), cathode (x, y + 46), collector (x + 90, y + 14), emitter (x + 90, y + 46)."""
        self.rectangle(x, y, 90, 60)
        self.path(f"M{x} {y + 14} h24 v8 M{x + 24} {y + 38} v8 h-24 M{x + 16} {y + 38} h16")
        self.path(f"M{x + 24} {y + 38} l-8 -16 h16 z", "full")
        self.path(f"M{x + 38} {y + 26} l10 0 m-4 -3 l4 3 l-4 3 M{x + 38} {y + 34} l10 0 m-4 -3 l4 3 l-4 3")
        self.path(f"M{x + 60} {y + 18} v24 M{x + 60} {y + 26} L{x + 74} {y + 14} H{x + 90} M{x + 60} {y + 34} L{x + 74} {y + 46} H{x + 90}")
        self.path(f"M{x + 74} {y + 46} l-8 -2 l4 -6 z", "full")
        for pin, px, py in (("1", x - 10, y + 11), ("2", x - 10, y + 43), ("4", x + 93, y + 11), ("3", x + 93, y + 43)):
            self.text(px, py, pin, "small")
        self.words(x + 45, y - 18, words, "middle")

    def svg(self):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" '
                f"font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" role=\"img\" aria-label=\"{html.escape(self.title)}\">\n"
                f"  <!-- made by scripts/tools/pictures/wiring.py -->\n  <style>{STYLE}\n  </style>\n"
                f'  <rect width="{self.width}" height="{self.height}" class="back"/>\n')
        return head + "\n".join(self.parts) + "\n</svg>\n"
