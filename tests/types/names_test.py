"""No field or constant of a message type has a name that C++, Python or Java keeps for itself."""
import keyword
import pathlib
import re
import sys
import unittest

# What the languages reserve, and what the generated classes have beside the fields.
CPP = """alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t char32_t class compl
concept const consteval constexpr constinit const_cast continue co_await co_return co_yield decltype default delete do
double dynamic_cast else enum explicit export extern false float for friend goto if inline int long mutable namespace
new noexcept not not_eq nullptr operator or or_eq private protected public register reinterpret_cast requires return
short signed sizeof static static_assert static_cast struct switch template this thread_local throw true try typedef
typeid typename union unsigned using virtual void volatile wchar_t while xor xor_eq
encode decode getEncodedSize getHash getTypeName"""
JAVA = """abstract assert boolean break byte case catch char class const continue default do double else enum extends
false final finally float for goto if implements import instanceof int interface long native new null package private
protected public return short static strictfp super switch synchronized this throw throws transient true try void
volatile while"""
PYTHON = [*keyword.kwlist, "encode", "decode", "self"]
RESERVED = {"C++": set(CPP.split()), "Java": set(JAVA.split()), "Python": set(PYTHON)}

FIELD = re.compile(r"\w+ (?P<name>\w+)(\[\w+\])*")
CONSTANT = re.compile(r"(?P<name>\w+) ?= ?[-\w.]+")


def names(text):
    """The names of a type's fields and constants."""
    body = re.search(r"{(.*)}", re.sub(r"//.*", "", text), re.DOTALL).group(1)
    for statement in filter(None, (" ".join(part.split()) for part in body.split(";"))):
        constants = re.fullmatch(r"const \w+ (.*)", statement)
        parts, form = (constants[1].split(", "), CONSTANT) if constants else ([statement], FIELD)
        yield from (form.fullmatch(part)["name"] for part in parts)


def reserved(text):
    return [(name, language) for name in names(text) for language, words in RESERVED.items() if name in words]


class Names(unittest.TestCase):
    def test_no_type_has_a_reserved_name(self):
        files = sorted(FOLDER.glob("*/*.lcm"))
        self.assertTrue(files)
        for file in files:
            with self.subTest(file.name):
                self.assertEqual(reserved(file.read_text()), [])

    def test_a_reserved_name_is_found(self):
        text = "struct a_t {\n // int8_t if;\n const int8_t final = 0, B = 1;\n double global[2][n]; string union;\n}"
        self.assertEqual(list(names(text)), ["final", "B", "global", "union"])
        self.assertEqual(reserved(text), [("final", "Java"), ("global", "Python"), ("union", "C++")])


if __name__ == "__main__":
    FOLDER = pathlib.Path(sys.argv.pop())
    unittest.main()
