"""Lists of places that are meant as they are: one a line, several in a group, and below them, indented, the reason."""


def read(path, pattern, form):
    """The groups of the pattern, for each place. What is not of the form, or has no reason of three words, ends the program."""
    places = []
    without_reason = 0
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines() + [""], 1):
        match = pattern.fullmatch(line)
        if line.startswith("#") or not line:
            if without_reason:
                raise SystemExit(f"{path}:{number}: the line above has no reason")
        elif line.startswith(" ") and len(line.split()) >= 3:
            without_reason = 0
        elif match:
            places.append(match.groups())
            without_reason += 1
        else:
            raise SystemExit(f"{path}:{number}: neither '{form}' nor, indented, a reason in three words or more")
    return places
