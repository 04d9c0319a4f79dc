"""The drawings of docs/wiring.md: three circuits, and each board with what is connected to its pins."""
from schematic import Drawing


def supply(d):
    d.text(24, 34, "Supply", "title")
    d.text(24, 98, "vehicle battery +", "bold")
    d.text(24, 114, "24 V (or 12 V)", "small")
    d.wire((160, 100), (180, 100))
    d.fuse(180, 100, 70, "F1 1 A slow")
    d.lying(250, 100, 90, Drawing.DIODE_DOWN, "D1 60 V 3 A|Schottky", below=True)
    d.wire((340, 100), (620, 100))
    d.dot(385, 100)
    d.tvs(385, 100, 70, "D2|SMCJ33A|(SMCJ18A)")
    d.ground(385, 170)
    d.dot(475, 100)
    d.capacitor(475, 100, 70, "C1|47 µF 100 V")
    d.ground(475, 170)
    d.dot(580, 100)
    d.rail(580, 76, "V+ (relays, loops, LED)")
    d.wire((580, 76), (580, 100))
    d.rectangle(620, 75, 170, 60)
    d.text(705, 100, "U3 DC/DC", "", "middle")
    d.text(705, 118, "9 to 72 V in, 5 V 0.5 A", "small", "middle")
    d.wire((705, 135), (705, 170))
    d.ground(705, 170)
    d.wire((790, 100), (815, 100))
    d.text(822, 98, "5 V", "bold")
    d.text(822, 114, "board, U1, U2", "small")
    d.text(24, 160, "vehicle battery −", "bold")
    d.wire((160, 156), (200, 156), (200, 170))
    d.ground(200, 170)


def transceiver(d):
    d.rectangle(330, 290, 150, 210)
    d.text(405, 386, "U1 (U2)", "bold", "middle")
    d.text(405, 404, "TJA1051T/3", "", "middle")
    for y, pin, name, words in ((330, "4", "RXD", "board: CAN RX"), (360, "1", "TXD", "board: CAN TX"), (470, "8", "S", "")):
        d.wire((230, y), (330, y))
        d.text(326, y - 5, pin, "small", "end")
        d.text(338, y + 4, name, "small")
        d.text(222, y + 4, words, "bold", "end")
    d.wire((230, 470), (130, 470))
    d.dot(200, 470)
    d.resistor(200, 470, 60, "R1|10 kΩ")
    d.ground(200, 530)
    d.path("M130 464 v12 M104 464 v12 M104 470 h-24 M80 470 v-12")
    d.text(117, 456, "J1", "", "middle")
    d.rail(80, 458, "3.3 V")
    for x, pin, name, words in ((365, "5", "VIO", "3.3 V (board)"), (445, "3", "VCC", "5 V")):
        d.wire((x, 290), (x, 266))
        d.rail(x, 266, words)
        d.text(x + 5, 286, pin, "small")
        d.text(x, 306, name, "small", "middle")
    d.wire((345, 500), (345, 530))
    d.text(350, 513, "2", "small")
    d.text(345, 494, "GND", "small", "middle")
    d.ground(345, 530)
    d.text(375, 524, "100 nF at VIO", "small")
    d.text(375, 538, "and at VCC", "small")


def bus_end(d):
    for y, pin, name in ((330, "7", "CANH"), (470, "6", "CANL")):
        d.wire((480, y), (840, y))
        d.text(484, y - 5, pin, "small")
        d.text(474, y + 4, name, "small", "end")
    d.text(848, 334, "CAN_H", "bold")
    d.text(848, 474, "CAN_L", "bold")
    d.dot(550, 330)
    d.dot(590, 470)
    d.wire((550, 330), (550, 505))
    d.wire((590, 470), (590, 505))
    d.rectangle(515, 505, 110, 30)
    d.text(570, 525, "D5 PESD2CAN", "small", "middle")
    d.wire((570, 535), (570, 542))
    d.ground(570, 542)
    d.dot(730, 330)
    d.path("M730 330 v12 M722 342 h16 M722 360 h16 M730 360 v6")
    d.text(746, 356, "J2", "")
    d.resistor(730, 366, 44, "60.4 Ω 0.5 W")
    d.dot(730, 412)
    d.resistor(730, 410, 60, "60.4 Ω 0.5 W")
    d.dot(730, 470)
    d.wire((730, 412), (670, 412), (670, 490))
    d.capacitor(670, 490, 50, "4.7 nF")
    d.ground(670, 540)
    d.wire((840, 512), (800, 512), (800, 524))
    d.ground(800, 524)
    d.text(848, 516, "GND", "bold")


def supply_and_can():
    d = Drawing(920, 620, "Supply, and a CAN transceiver with its bus")
    supply(d)
    d.text(24, 236, "CAN: one transceiver (a gateway has two)", "title")
    transceiver(d)
    bus_end(d)
    d.text(24, 588, "J1 open: normal. J1 closed: silent, the transceiver cannot send (closed until step 4 of the checklist).", "small")
    d.text(24, 606, "J2 closed only where the supervisor is at the end of this bus.", "small")
    return d.svg()


def output():
    d = Drawing(920, 600, "Safety output: two relays with force-guided contacts, and the feedback of their mirror contacts")
    d.text(24, 34, "Safety output: drivers", "title")
    d.wire((260, 78), (480, 78))
    d.rail(380, 78, "V+")
    d.dot(380, 78)
    for x, number in ((260, 1), (480, 2)):
        d.coil(x, 78, 90, f"K{number}", -1)
        d.text(x - 6, 104, "A1", "small", "end")
        d.text(x - 6, 152, "A2", "small", "end")
        d.wire((x, 84), (x + 55, 84))
        d.dot(x, 84)
        d.diode(x + 55, 84, 78, f"D{number + 2}|1N4007")
        d.wire((x + 55, 162), (x, 162))
        d.dot(x, 162)
        d.wire((x, 168), (x, 190))
        d.transistor(x - 34, 220, f"Q{number}|IRLML0060")
        d.wire((x, 250), (x, 262))
        d.ground(x, 262)
        d.dot(x - 60, 220)
        d.wire((x - 60, 220), (x - 34, 220))
        d.resistor(x - 60, 220, 60, "10 kΩ", -1)
        d.ground(x - 60, 280)
    d.text(24, 208, "board:", "bold")
    d.text(24, 224, "safety", "bold")
    d.text(24, 240, "output", "bold")
    d.wire((76, 220), (110, 220))
    d.lying(110, 220, 90, Drawing.RESISTOR, "100 Ω")
    d.dot(92, 220)
    d.wire((92, 220), (92, 326), (345, 326), (345, 220))
    d.lying(345, 220, 75, Drawing.RESISTOR, "100 Ω")
    d.text(640, 84, "K1, K2: force-guided contacts", "bold")
    d.text(640, 102, "(EN 61810-3 type A), 1 NO + 1 NC,", "small")
    d.text(640, 118, "coil for 24 V (or 12 V), up to 100 mA", "small")
    d.text(640, 144, "Released = open = safe:", "bold")
    d.text(640, 162, "without supply, in reset, with a broken", "small")
    d.text(640, 178, "wire to a gate, a coil or a contact", "small")
    d.text(24, 376, "Safety output: contacts", "title")
    d.text(24, 426, "drive enable +", "bold")
    d.wire((148, 422), (150, 422))
    d.contact(150, 422, 160, "S1, emergency stop", True, ("11", "12"))
    d.contact(310, 422, 130, "K1", False, ("13", "14"))
    d.contact(440, 422, 130, "K2", False, ("13", "14"))
    d.wire((570, 422), (690, 422))
    d.text(698, 420, "drive enable input of the", "bold")
    d.text(698, 436, "VCU, or contactor (≤ 6 A)", "bold")
    d.dot(620, 422)
    d.resistor(620, 422, 62, "R5 2.2 kΩ 1 W|(1 kΩ at 12 V)")
    d.ground(620, 484)
    d.text(24, 526, "V+", "bold")
    d.wire((50, 522), (310, 522))
    d.contact(310, 522, 130, "K1 mirror", True, ("21", "22"))
    d.contact(440, 522, 130, "K2 mirror", True, ("21", "22"))
    d.wire((570, 522), (690, 522))
    d.text(698, 526, "input stage B1: feedback", "bold")
    d.text(24, 566, "Contacts are drawn without current. S1 is the vehicle's own emergency stop: it opens the drive enable without the supervisor.", "small")
    d.text(24, 584, "The feedback is closed only when both relays have released. A welded contact keeps its mirror contact open.", "small")
    return d.svg()


def inputs():
    d = Drawing(920, 640, "Inputs, each with an optocoupler, and the alarm LED")
    d.text(24, 34, "Inputs: the stage B, built three times", "title")
    d.text(24, 104, "from the loop", "bold")
    d.wire((130, 100), (140, 100))
    d.lying(140, 100, 110, Drawing.RESISTOR, "2.2 kΩ 1 W|(1 kΩ at 12 V)")
    d.wire((250, 100), (400, 100))
    d.dot(330, 100)
    d.diode(330, 100, 32, "", 1)
    d.text(318, 120, "1N4148", "small", "end")
    d.dot(330, 132)
    d.coupler(400, 86, "B1 … B3|PC817")
    d.wire((400, 132), (280, 132), (280, 150))
    d.ground(280, 150)
    d.wire((490, 132), (520, 132), (520, 150))
    d.ground(520, 150)
    d.wire((490, 100), (700, 100))
    d.dot(570, 100)
    d.wire((570, 100), (570, 84))
    d.upright(570, 40, 44, Drawing.RESISTOR, "10 kΩ")
    d.rail(570, 40, "3.3 V (board)")
    d.dot(640, 100)
    d.capacitor(640, 100, 50, "10 nF")
    d.ground(640, 150)
    d.text(708, 98, "board: input", "bold")
    d.text(708, 114, "low while current flows", "small")
    d.text(24, 216, "The three loops", "title")
    rows = ((266, "to B1, feedback", (("K1 mirror", True, ("21", "22")), ("K2 mirror", True, ("21", "22"))),
             "Current: output open. A broken wire reads", "closed: the output is not closed (again)."),
            (346, "to B2, emergency stop", (("S1, second contact", True, ("21", "22")),),
             "Current: not pressed. A broken wire reads", "pressed: the vehicle stops."),
            (426, "to B3, push button", (("S2", False, ("13", "14")),), "Current: pressed. A broken wire: no reset.", ""))
    for y, name, contacts, means, also in rows:
        d.text(24, y + 4, "V+", "bold")
        d.wire((48, y), (70, y))
        x = 70
        for words, closed, pins in contacts:
            d.contact(x, y, 150, words, closed, pins)
            x += 150
        d.wire((x, y), (400, y))
        d.text(408, y + 4, name, "bold")
        d.text(590, y - 2 if also else y + 4, means, "small")
        d.text(590, y + 14, also, "small")
    d.text(24, 494, "Alarm LED (a second one, where the operator sees it)", "title")
    d.text(24, 574, "board: LED", "bold")
    d.lying(116, 570, 84, Drawing.RESISTOR, "100 Ω")
    d.dot(215, 570)
    d.wire((200, 570), (236, 570))
    d.resistor(215, 570, 40, "")
    d.text(203, 596, "10 kΩ", "small", "end")
    d.ground(215, 610)
    d.transistor(236, 570, "Q3|IRLML0060")
    d.wire((270, 600), (270, 606))
    d.ground(270, 606)
    d.wire((270, 540), (480, 540))
    d.lying(480, 540, 60, Drawing.DIODE_UP, "H1", below=True)
    d.text(560, 560, "signal lamp for V+: LED with its resistor", "small")
    d.wire((540, 540), (600, 540), (600, 532))
    d.rail(600, 532, "V+")
    return d.svg()


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
    drawings = {"wiring-supply-can.svg": supply_and_can(), "wiring-output.svg": output(), "wiring-inputs.svg": inputs()}
    for name, pins in tables.items():
        drawings[f"wiring-{name.replace('_', '-')}.svg"] = board(name, pins)
    return drawings
