"""The drawings of the boards in docs/wiring.md: each board with what is connected to its pins. SVG that is readable in light and in
dark mode, and printed."""
import html

STYLE = """
    .back { fill: #ffffff } .ink { stroke: #1b2733; stroke-width: 1.6; fill: none; stroke-linejoin: round; stroke-linecap: round }
    .part { stroke: #1b2733; stroke-width: 1.6; fill: #eef3f8 } .dot { fill: #1b2733 }
    .board { stroke: #b36b00; stroke-width: 2; fill: #fff3d6 }
    text { fill: #1b2733; font-size: 13px } .small { font-size: 11.5px; fill: #44525f } .bold { font-weight: bold }
    .title { font-size: 16px; font-weight: bold }
    @media (prefers-color-scheme: dark) {
      .back { fill: #10161c } .ink, .part { stroke: #dfe7ee } .part { fill: #1e2a35 } .dot { fill: #dfe7ee }
      .board { stroke: #e0a040; fill: #33270f } text { fill: #e8eef3 } .small { fill: #b4c0ca }
    }
    @media print {
      .back { fill: #ffffff } .ink, .part { stroke: #000000 } .part { fill: #ffffff } .dot { fill: #000000 }
      .board { stroke: #000000; fill: #ffffff } text, .small { fill: #000000 }
    }"""


class Drawing:
    """Each method draws one thing and gives nothing back."""

    def __init__(self, width, height, title):
        self.width, self.height, self.title, self.parts = width, height, title, []

    def text(self, x, y, words, kind="", anchor="start"):
        self.parts.append(f'  <text x="{x}" y="{y}" class="{kind}" text-anchor="{anchor}">{html.escape(words)}</text>')

    def wire(self, start, end):
        self.parts.append(f'  <path d="M{start[0]} {start[1]} L{end[0]} {end[1]}" class="ink"/>')

    def dot(self, x, y):
        self.parts.append(f'  <circle cx="{x}" cy="{y}" r="3.2" class="dot"/>')

    def rectangle(self, x, y, width, height, kind="part"):
        self.parts.append(f'  <rect x="{x}" y="{y}" width="{width}" height="{height}" rx="3" class="{kind}"/>')

    def svg(self):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" '
                f"font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" role=\"img\" aria-label=\"{html.escape(self.title)}\">\n"
                f"  <!-- made by scripts/tools/pictures/wiring.py -->\n  <style>{STYLE}\n  </style>\n"
                f'  <rect width="{self.width}" height="{self.height}" class="back"/>\n')
        return head + "\n".join(self.parts) + "\n</svg>\n"


BLOCKS = (  # what stands on the left, its rows, and what stands beside it
    ("U1, vehicle side", ("vehicle side RX", "vehicle side TX"), {"vehicle side RX": "4 RXD", "vehicle side TX": "1 TXD"}),
    ("U2, AI side (gateway only)", ("AI side RX", "AI side TX"), {"AI side RX": "4 RXD", "AI side TX": "1 TXD"}),
    ("Q1, Q2: safety output", ("safety output",), {"safety output": "gate, 100 Ω"}),
    ("B1: feedback", ("feedback",), {"feedback": "4 collector"}),
    ("B2: emergency stop", ("emergency stop",), {"emergency stop": "4 collector"}),
    ("B3: push button", ("push button",), {"push button": "4 collector"}),
    ("Q3: alarm LED", ("LED",), {"LED": "gate, 100 Ω"}),
    ("U3: supply", ("5 V in", "3.3 V out", "GND"), {"5 V in": "5 V", "3.3 V out": "VIO, pull-ups", "GND": "GND"}),
    ("vehicle bus", ("vehicle CAN_H", "vehicle CAN_L", "vehicle GND"), {}),
    ("AI computer (gateway only)", ("AI CAN_H", "AI CAN_L", "AI GND"), {}),
)


def board(name, pins):
    blocks = [(title, [signal for signal in signals if signal in pins and pins[signal][1] != "on the board"], words)
              for title, signals, words in BLOCKS]
    blocks = [block for block in blocks if block[1]]
    height = 110 + sum(26 * len(signals) + 26 for _, signals, _ in blocks)
    d = Drawing(760, height, f"Pins of {name}")
    d.text(24, 34, name, "title")
    d.text(736, 34, "Not built, not measured", "small", "end")
    d.rectangle(470, 52, 266, height - 70, "board")
    d.text(490, 72, "connector", "small bold")
    d.text(640, 72, "processor", "small bold")
    y = 84
    for title, signals, words in blocks:
        d.rectangle(24, y, 290, 26 * len(signals) + 14)
        d.text(36, y + 20, title)
        for signal in signals:
            row = y + 20 + 26 * signals.index(signal)
            pin, connector = pins[signal]
            d.text(304, row, words.get(signal, signal.partition(" ")[2]), "small", "end")
            d.wire((314, row - 4), (484, row - 4))
            d.dot(484, row - 4)
            d.text(494, row, connector, "bold")
            d.text(640, row, "" if pin == "-" else pin)
        y += 26 * len(signals) + 26
    return d.svg()


def all_of(tables):
    return {f"wiring-{name.replace('_', '-')}.svg": board(name, pins) for name, pins in tables.items()}
