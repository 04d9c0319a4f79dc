"""The mutants of a C file, found in its syntax tree (libclang).

A mutant replaces one piece of text. Its id says where and how: file:line:column:operator:replacement, where line and
column are those of the operator, the constant or the statement that is replaced. Macro bodies are not mutated, what
stands at their place of use is. Two mutants with the same text are one.
"""
import collections
import re

import clang.cindex
from clang.cindex import CursorKind as Kind
from clang.cindex import TypeKind

# text: what stands in the file between start and end (offsets) afterwards; lines: those of the whole statement;
# function: the name of the function around it, "" in a table
Mutant = collections.namedtuple("Mutant", "id file line operator start end text lines function")

RELATIONAL = {"<": ("<=", ">="), ">": (">=", "<="), "<=": ("<", ">"), ">=": (">", "<"),
              "==": ("!=", "<=", ">="), "!=": ("==", "<", ">")}
ARITHMETIC = {"+": "-", "-": "+", "*": "/", "/": "*", "%": "/", "&": "|", "|": "&", "^": "|", "<<": ">>", ">>": "<<"}
LOGICAL = {"&&": "||", "||": "&&"}
OPERATORS = ("relational", "arithmetic", "logical", "constant", "statement", "return")
STATEMENTS = (Kind.CALL_EXPR, Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR, Kind.UNARY_OPERATOR,
              Kind.CSTYLE_CAST_EXPR, Kind.BREAK_STMT, Kind.CONTINUE_STMT, Kind.RETURN_STMT)
NUMBER = re.compile(r"(0[xX][0-9a-fA-F]+|\d+)([uUlL]*)")
INTEGERS = (TypeKind.BOOL, TypeKind.UCHAR, TypeKind.USHORT, TypeKind.UINT, TypeKind.ULONG, TypeKind.ULONGLONG,
            TypeKind.SCHAR, TypeKind.CHAR_S, TypeKind.SHORT, TypeKind.INT, TypeKind.LONG, TypeKind.LONGLONG, TypeKind.ENUM)


class Finder:
    """Walks one file. around: the cursors from the function, or table, down to the one that is looked at."""

    def __init__(self, path, name, arguments):
        self.source = path.read_bytes().decode("ascii")
        self.path, self.name = str(path), name
        self.found = {}
        unit = clang.cindex.Index.create().parse(str(path), args=arguments)
        errors = [d.spelling for d in unit.diagnostics if d.severity >= clang.cindex.Diagnostic.Error]
        if errors:
            raise SystemExit(f"{path}: {errors[0]}")
        for cursor in unit.cursor.get_children():
            self.walk(cursor, [])

    def text(self, cursor):
        return self.source[cursor.extent.start.offset:cursor.extent.end.offset]

    def add(self, around, operator, at, start, end, text, name=None):
        """at: the offset that gives line and column; name: what the id says when that is not the text."""
        changed = self.source[:start] + text + self.source[end:]
        if text == self.source[start:end] or changed in self.found:
            return
        line = self.source.count("\n", 0, at) + 1
        column = at - self.source.rfind("\n", 0, at)
        # the innermost statement in which it stands: its lines are those that a test has to run
        statement = next((c for c, outer in zip(around[::-1], around[-2::-1]) if outer.kind in BODIES), around[0])
        body = next((c for c in statement.get_children() if c.kind == Kind.COMPOUND_STMT), None)
        lines = statement.extent.start.line, body.extent.start.line if body else statement.extent.end.line
        function = around[0].spelling if around[0].kind == Kind.FUNCTION_DECL else ""
        key = f"{self.name}:{line}:{column}:{operator}:{name or text}"
        self.found[changed] = Mutant(key, self.name, line, operator, start, end, text, lines, function)

    def walk(self, cursor, around):
        here = cursor.location.file is not None and cursor.location.file.name == self.path
        if not here or cursor.kind in (Kind.STATIC_ASSERT, Kind.PARM_DECL, Kind.CXX_UNARY_EXPR, Kind.STRUCT_DECL):
            return
        around = around + [cursor]
        visit = VISITS.get(cursor.kind)
        if visit:
            visit(self, cursor, list(cursor.get_children()), around)
        for child in cursor.get_children():
            # of a declaration only what stands behind the '=', no array size
            if cursor.kind != Kind.VAR_DECL or child.extent.end.offset == cursor.extent.end.offset:
                self.walk(child, around)

    def operator(self, children):
        """What stands between two operands, and where."""
        begin, end = children[0].extent.end.offset, children[1].extent.start.offset
        token = re.sub(r"/\*.*?\*/", "", self.source[begin:end], flags=re.DOTALL).strip()
        return token, self.source.find(token, begin)

    def binary(self, cursor, children, around):
        left, right = (self.text(child) for child in children)
        token, at = self.operator(children)
        start, end = cursor.extent.start.offset, cursor.extent.end.offset

        def replace(operator, new):
            self.add(around, operator, at, start, end, f"(({left}) {new} ({right}))", new)

        for new in RELATIONAL.get(token, ()):
            replace("relational", new)
        if token in ARITHMETIC:
            replace("arithmetic", ARITHMETIC[token])
        if token in LOGICAL:
            replace("logical", LOGICAL[token])
            self.add(around, "logical", at, start, end, f"({left})", "left")
            self.add(around, "logical", at, start, end, f"({right})", "right")

    def assignment(self, _cursor, children, around):
        token, at = self.operator(children)
        self.add(around, "arithmetic", at, at, at + len(token), ARITHMETIC[token[:-1]] + "=")

    def unary(self, cursor, children, around):
        start, end = cursor.extent.start.offset, cursor.extent.end.offset
        operand = self.text(children[0])
        token = self.text(cursor).replace(operand, "", 1).strip()
        if token in ("++", "--"):
            new = "--" if token == "++" else "++"
            at = self.source.find(token, start)
            self.add(around, "arithmetic", at, at, at + 2, new)
        elif token in ("!", "~", "-"):
            self.add(around, "logical" if token == "!" else "arithmetic", start, start, end, f"({operand})", "operand")

    def condition(self, around, cursor):
        """Negated, unless another operator does that."""
        inner = cursor
        while inner.kind in (Kind.PAREN_EXPR, Kind.UNEXPOSED_EXPR):
            inner = next(inner.get_children())
        text = self.text(inner)
        relation = inner.kind == Kind.BINARY_OPERATOR and self.operator(list(inner.get_children()))[0] in RELATIONAL
        if not relation and not (inner.kind == Kind.UNARY_OPERATOR and text.startswith("!")):
            start, end = cursor.extent.start.offset, cursor.extent.end.offset
            self.add(around, "logical", start, start, end, f"(!({self.text(cursor)}))", "!")

    def choice(self, _cursor, children, around):
        self.condition(around, children[0])

    def loop(self, cursor, children, around):
        start = cursor.extent.start.offset
        first = self.source.find(";", start)
        second = self.source.find(";", first + 1)
        for child in children:
            if first < child.extent.start.offset and child.extent.end.offset <= second:
                self.condition(around, child)

    def constant(self, cursor, _children, around):
        start, end = cursor.extent.start.offset, cursor.extent.end.offset
        text = self.source[start:end]
        number = NUMBER.fullmatch(text)
        if number:
            value = int(number[1], 0)
            for new in (value + 1, value - 1)[:2 if value else 1]:
                self.add(around, "constant", start, start, end, f"{new}{number[2]}")
        elif text in ("true", "false"):
            self.add(around, "constant", start, start, end, "false" if text == "true" else "true")
        elif re.fullmatch(r"[A-Z]\w*", text):
            self.add(around, "constant", start, start, end, plus_one(text), "+1")

    def reference(self, cursor, children, around):
        if cursor.referenced is not None and cursor.referenced.kind == Kind.ENUM_CONSTANT_DECL:
            self.constant(cursor, children, around)

    def result(self, cursor, children, around):
        if not children:
            return
        kind = around[0].result_type.get_canonical().kind
        start, end = children[0].extent.start.offset, children[0].extent.end.offset
        if kind == TypeKind.BOOL:
            new = ("true", "false")
        elif kind == TypeKind.POINTER:
            new = ("NULL",)
        elif kind in INTEGERS:
            new = ("0", "1") if NUMBER.fullmatch(self.text(children[0])) else ("0", plus_one(self.text(children[0])))
        else:
            new = ()
        for text in new:
            self.add(around, "return", cursor.extent.start.offset, start, end, text, "+1" if text.endswith("+ 1)") else text)

    def body(self, _cursor, children, around):
        """Deletes statements, but no return without which a function with a result would end without one."""
        for child in children:
            outer = around
            while child.kind in (Kind.CASE_STMT, Kind.DEFAULT_STMT):
                outer = outer + [child]
                child = list(child.get_children())[-1]
            needed = child.kind == Kind.RETURN_STMT and around[0].result_type.kind != TypeKind.VOID and ends(outer + [child])
            if child.kind in STATEMENTS and not needed:
                start, end = child.extent.start.offset, child.extent.end.offset
                self.add(outer + [child], "statement", start, start, end, "(void)0", "deleted")


def ends(around):
    """Whether nothing of the function comes behind the last of these cursors."""
    return all(list(outer.get_children())[-1] == inner for outer, inner in zip(around, around[1:]))


# statements stand in these
BODIES = (Kind.COMPOUND_STMT, Kind.CASE_STMT, Kind.DEFAULT_STMT)
VISITS = {
    Kind.BINARY_OPERATOR: Finder.binary,
    Kind.COMPOUND_ASSIGNMENT_OPERATOR: Finder.assignment,
    Kind.UNARY_OPERATOR: Finder.unary,
    Kind.CONDITIONAL_OPERATOR: Finder.choice,
    Kind.IF_STMT: Finder.choice,
    Kind.WHILE_STMT: Finder.choice,
    Kind.FOR_STMT: Finder.loop,
    Kind.INTEGER_LITERAL: Finder.constant,
    Kind.DECL_REF_EXPR: Finder.reference,
    Kind.RETURN_STMT: Finder.result,
    Kind.COMPOUND_STMT: Finder.body,
}


def plus_one(text):
    return f"({text} + 1)" if re.fullmatch(r"\w+", text) else f"(({text}) + 1)"


def find(path, name, arguments):
    """All mutants of a file, in the order of the text."""
    mutants = list(Finder(path, name, arguments).found.values())
    return sorted(mutants, key=lambda mutant: (mutant.start, mutant.end, mutant.id))
