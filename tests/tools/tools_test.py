"""tools/check_units.py and check_layers.py on small trees, tools/build_times.py on a log of five lines."""
import contextlib
import importlib.util
import io
import tempfile
import unittest
from pathlib import Path

TOOLS = Path(__file__).resolve().parents[2] / "tools"


def load(name):
    spec = importlib.util.spec_from_file_location(name, TOOLS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def local(body):
    return f"namespace proofmass {{\nnamespace {{\n\n{body}\n\n}}  // namespace\n}}  // namespace proofmass\n"


class CheckRooms(unittest.TestCase):
    def offences(self, rooms, **sources):
        """The offences reported for a module of the rooms `above` and `below`, with one source each."""
        check_layers = load("check_layers")
        with tempfile.TemporaryDirectory() as root:
            check_layers.ROOT = Path(root)
            check_layers.LIBRARY = Path(root, "src/proofmass")
            module = Path(root, "src/proofmass/io")
            listed = []
            for room in ("above", "below"):
                (module / room).mkdir(parents=True)
                (module / room / "one.cpp").write_text(sources.get(room, ""))
                (module / room / "one.hpp").write_text("")
                listed.append(f"{room}/one.cpp")
            (module / "CMakeLists.txt").write_text(f"proofmass_module(io\n  {rooms}\n  SOURCES {' '.join(listed)})\n")
            said = io.StringIO()
            with contextlib.redirect_stdout(said):
                status = check_layers.main()
        return said.getvalue().splitlines() if status else []

    INCLUDES_BELOW = '#include "proofmass/io/below/one.hpp"\n'

    def test_a_room_may_include_what_its_entry_names(self):
        self.assertEqual(self.offences('ROOMS "above: below"', above=self.INCLUDES_BELOW), [])

    def test_a_room_may_not_include_another(self):
        (found,) = self.offences("", above=self.INCLUDES_BELOW)
        self.assertIn("above/one.cpp:1: the room above may not include below", found)

    def test_an_entry_that_no_source_needs_is_refused(self):
        (found,) = self.offences('ROOMS "above: below"')
        self.assertIn("ROOMS has above: below, but no source of above includes it", found)

    def test_a_cycle_of_rooms_is_refused(self):
        (found,) = self.offences('ROOMS "above: below" "below: above"', above=self.INCLUDES_BELOW,
                                 below='#include "proofmass/io/above/one.hpp"\n')
        self.assertIn("cycle in io:", found)


class CheckUnits(unittest.TestCase):
    def offences(self, one, two, rest=""):
        """The offences reported for one.cpp and two.cpp in a unit, with rest.cpp beside it."""
        check_units = load("check_units")
        with tempfile.TemporaryDirectory() as root:
            check_units.ROOT = Path(root)
            module = Path(root, "src/proofmass/core")
            module.mkdir(parents=True)
            Path(root, "apps/proofmass").mkdir(parents=True)
            Path(root, "apps/proofmass/CMakeLists.txt").write_text("")
            (module / "CMakeLists.txt").write_text(
                'proofmass_module(core\n  UNITS\n    "both: one.cpp\n      two.cpp"\n  SOURCES rest.cpp)\n')
            for name, text in (("one", one), ("two", two), ("rest", rest)):
                (module / f"{name}.cpp").write_text(text)
            said = io.StringIO()
            with contextlib.redirect_stdout(said):
                status = check_units.main()
        self.assertEqual(status, 1 if "1 units" not in said.getvalue() else 0)
        return [] if status == 0 else said.getvalue().splitlines()

    def test_names_of_their_own_may_share_a_unit(self):
        self.assertEqual(self.offences(local("constexpr int one = 1;"), local("constexpr int two = 2;")), [])

    def test_a_constant_of_the_same_name_is_refused(self):
        found = self.offences(local("constexpr int most = 1;"), local("constexpr double most = 2.0;"))
        self.assertEqual(len(found), 1)
        self.assertIn("most in each of one.cpp, two.cpp", found[0])

    def test_a_source_outside_the_unit_may_have_the_name(self):
        self.assertEqual(self.offences(local("constexpr int most = 1;"), local("int other = 2;"),
                                       local("constexpr int most = 3;")), [])

    def test_overloads_on_numbers_are_refused(self):
        self.assertEqual(len(self.offences(local("double scaled(double x) {"), local("double scaled(int x) {"))), 1)

    def test_overloads_on_classes_of_ours_are_not(self):
        self.assertEqual(self.offences(local("void show(const Wheel& wheel) {"),
                                       local("void show(const Track& track) {")), [])

    def test_overloads_on_the_same_class_are(self):
        self.assertEqual(len(self.offences(local("void show(const Wheel& wheel) {"),
                                           local("void show(const Wheel& wheel, int more) {"))), 1)

    def test_a_name_outside_the_anonymous_namespace_is_the_linkers_matter(self):
        self.assertEqual(self.offences("int most() {\n  return 1;\n}\n", local("constexpr int most = 2;")), [])

    def test_a_using_directive_is_refused_with_its_line(self):
        found = self.offences("\nusing namespace std;\n", local("int two = 2;"))
        self.assertEqual(len(found), 1)
        self.assertIn("one.cpp:2", found[0])

    def test_a_macro_is_refused_unless_it_is_undefined_again(self):
        self.assertEqual(len(self.offences("#define MOST 3\n", "")), 1)
        self.assertEqual(self.offences("#define MOST 3\n#undef MOST\n", ""), [])


class BuildTimes(unittest.TestCase):
    LOG = ("# ninja log v5\n"
           "0\t2500\t1\tsrc/proofmass/io/CMakeFiles/proofmass_io.dir/csv.cpp.o\tabc\n"
           "0\t9000\t1\tsrc/proofmass/io/CMakeFiles/proofmass_io.dir/gone.cpp.o\tabc\n"
           "2500\t3500\t1\tsrc/proofmass/io/CMakeFiles/io_test.dir/csv_test.cpp.o\tabc\n"
           "3500\t9000\t1\tproofmass\tabc\n"
           "9000\t9750\t2\tsrc/proofmass/io/CMakeFiles/proofmass_io.dir/csv.cpp.o\tdef\n")

    def read(self, text):
        build_times = load("build_times")
        with tempfile.TemporaryDirectory() as folder:
            for line in text.splitlines()[1:]:
                if "gone" not in line:
                    output = Path(folder, line.split("\t")[3])
                    output.parent.mkdir(parents=True, exist_ok=True)
                    output.touch()
            log = Path(folder, ".ninja_log")
            log.write_text(text)
            return build_times, build_times.read_log(log)

    def test_counts_the_last_compilation_of_objects_that_exist(self):
        build_times, seconds = self.read(self.LOG)
        self.assertEqual({build_times.unit_of(output): s for output, s in seconds.items()},
                         {"io/csv.cpp": 0.75, "io tests/csv_test.cpp": 1.0})

    def test_refuses_a_log_that_it_does_not_know(self):
        with self.assertRaises(SystemExit):
            self.read("# ninja log v4\n")


if __name__ == "__main__":
    unittest.main()
