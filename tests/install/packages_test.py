"""The Debian packages made from the finished build: their metadata, their contents, and that these work at the
location where dpkg would unpack them. Nothing is installed."""
import gzip
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

BUILD, SOURCE = Path(os.environ["BUILD"]), Path(os.environ["SOURCE"])
CMAKE, COMPILER = os.environ["CMAKE"], os.environ["COMPILER"]
TOOLS = ("dpkg-deb", "dpkg-shlibdeps", "gzip")


def output(*command, **how) -> str:
    ran = subprocess.run([*map(str, command)], capture_output=True, text=True, timeout=250, **how)
    if ran.returncode != 0:
        raise AssertionError(f"{command} ended with {ran.returncode}:\n{ran.stdout}{ran.stderr}")
    return ran.stdout


@unittest.skipUnless(all(map(shutil.which, TOOLS)), f"one of {', '.join(TOOLS)} is missing")
class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.work = Path(tempfile.mkdtemp(prefix="proofmass-packages-"))
        cls.addClassCleanup(shutil.rmtree, cls.work)
        cls.root = cls.work / "root"
        # Released packages are compressed by xz; the test uses a faster compression.
        cpack = Path(CMAKE).with_name("cpack")
        output(cpack, "--config", BUILD / "CPackConfig.cmake", "-B", cls.work / "deb",
               "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip")  # fmt: skip
        cls.packages = {path.name.split("_")[0]: path for path in (cls.work / "deb").glob("*.deb")}
        for package in cls.packages.values():
            output("dpkg-deb", "--extract", package, cls.root)
        cls.loader = {**os.environ, "LD_LIBRARY_PATH": str(cls.root / "usr/lib")}

    def field(self, package: str, name: str) -> str:
        return output("dpkg-deb", "--field", self.packages[package], name).strip()

    def files(self, package: str) -> set[str]:
        lines = output("dpkg-deb", "--contents", self.packages[package]).splitlines()
        return {line.split()[5].removeprefix(".") for line in lines if not line.startswith("d")}

    def verbs(self) -> list[str]:
        lines = output(self.root / "usr/bin/proofmass", "__complete", "").splitlines()
        return [line.split("\t")[0] for line in lines]

    def test_each_is_there_and_says_what_it_depends_on(self):
        expected = {"proofmass", "libproofmass0.1", "libproofmass-dev"}
        if (BUILD / "python/proofmass").is_dir():
            expected.add("python3-proofmass")
            self.assertRegex(self.field("python3-proofmass", "Depends"), r"python3 \(<< 3\.\d+\), python3-numpy")
        self.assertEqual(set(self.packages), expected)
        version = self.field("proofmass", "Version")
        self.assertRegex(version, r"^\d+\.\d+\.\d+-\d+$")
        for package in ("proofmass", "libproofmass0.1"):
            self.assertRegex(self.field(package, "Depends"), r"\blibc6 \(>= .*\blibzip4")
        self.assertIn(f"libproofmass0.1 (= {version})", self.field("libproofmass-dev", "Depends"))
        self.assertIn("libeigen3-dev", self.field("libproofmass-dev", "Depends"))
        self.assertIn("libfmt-dev", self.field("libproofmass-dev", "Recommends"))

    def test_the_library_is_told_to_the_loader_and_to_packages_that_need_it(self):
        def control(name: str) -> str:
            return output("dpkg-deb", "--info", self.packages["libproofmass0.1"], name).strip()

        version = self.field("libproofmass0.1", "Version")
        self.assertEqual(control("shlibs"), f"libproofmass 0.1 libproofmass0.1 (= {version})")
        self.assertEqual(control("triggers"), "activate-noawait ldconfig")

    def test_no_file_is_in_two_and_each_brings_licence_and_changelog(self):
        seen = {}
        for package in self.packages:
            files = self.files(package)
            self.assertIn(f"/usr/share/doc/{package}/copyright", files)
            self.assertIn(f"/usr/share/doc/{package}/changelog.Debian.gz", files)
            for file in files:
                self.assertNotIn(file, seen, f"{package} and {seen.get(file)}")
                seen[file] = package

    def test_whatever_a_package_is_for_is_in_it(self):
        self.assertIn("/usr/lib/libproofmass.so.0.1", self.files("libproofmass0.1"))
        development = self.files("libproofmass-dev")
        self.assertIn("/usr/lib/libproofmass.so", development)
        self.assertIn("/usr/lib/libproofmass_estimate.a", development)
        self.assertIn("/usr/include/proofmass/estimate/wheel.hpp", development)
        program = self.files("proofmass")
        self.assertIn("/usr/bin/proofmass", program)
        self.assertIn("/usr/share/bash-completion/completions/proofmass", program)
        self.assertIn("/usr/share/zsh/vendor-completions/_proofmass", program)
        self.assertIn("/usr/share/fish/vendor_completions.d/proofmass.fish", program)

    def test_every_verb_has_a_man_page(self):
        pages = {file for file in self.files("proofmass") if "/man1/" in file}
        wanted = {f"/usr/share/man/man1/proofmass-{verb}.1.gz" for verb in self.verbs()}
        self.assertEqual(pages, wanted | {"/usr/share/man/man1/proofmass.1.gz"})

    def test_man_pages_are_without_fault(self):
        if not shutil.which("mandoc"):
            self.skipTest("mandoc is missing")
        for page in sorted((self.root / "usr/share/man/man1").iterdir()):
            ran = subprocess.run(["mandoc", "-T", "lint", "-W", "warning", page], capture_output=True, text=True)
            self.assertEqual(ran.stdout, "", page.name)

    def test_a_man_page_has_every_flag_and_the_exit_statuses(self):
        page = gzip.decompress((self.root / "usr/share/man/man1/proofmass-record.1.gz").read_bytes())
        text = page.decode().replace("\\-", "-")
        said = output(self.root / "usr/bin/proofmass", "record", "--help")
        flags = set(re.findall(r"^  (?:-\w,)?(--[a-z-]+)", said, re.M))
        self.assertGreater(len(flags), 20)
        for flag in flags:
            self.assertIn(f"\\fB{flag}\\fR", text)
        for heading in ("SYNOPSIS", "DESCRIPTION", "ARGUMENTS", "OPTIONS", "EXAMPLES", "EXIT STATUS", "SEE ALSO"):
            self.assertIn(f"\n.SH {heading}\n", text)

    def test_the_program_runs(self):
        program = self.root / "usr/bin/proofmass"
        self.assertEqual(output(program, "--version").strip(), f"proofmass {self.field('proofmass', 'Version').split('-')[0]}")
        rig = self.work / "rig.csv"
        output(program, "simulate", "--duration", "5", "-o", rig)
        self.assertIn("200 Hz for 5 s, 6 channels", output(program, "inspect", rig))

    def test_the_python_module_runs(self):
        if "python3-proofmass" not in self.packages:
            self.skipTest("built without the Python module")
        code = "import proofmass as pm; print(pm.simulate(duration=5).recording.samples, pm.__version__)"
        said = output("/usr/bin/python3", "-c", code,
                      env={**os.environ, "PYTHONPATH": str(self.root / "usr/lib/python3/dist-packages")})  # fmt: skip
        self.assertEqual(said.split(), ["1000", self.field("python3-proofmass", "Version").split("-")[0]])

    def test_programs_are_built_against_both_kinds_of_library(self):
        build = self.work / "consumer"
        output(CMAKE, "-S", SOURCE / "tests/install/consumer", "-B", build, "-G", "Ninja",
               f"-DCMAKE_PREFIX_PATH={self.root}/usr", f"-DCMAKE_CXX_COMPILER={COMPILER}")  # fmt: skip
        output(CMAKE, "--build", build)
        said = output(build / "consumer_shared", env=self.loader)
        self.assertEqual(said, output(build / "consumer_static"))
        self.assertIn("NEEDED", output("objdump", "-p", build / "consumer_shared"))
        self.assertIn("libproofmass.so.0.1", output("objdump", "-p", build / "consumer_shared"))
        self.assertNotIn("libproofmass", output("objdump", "-p", build / "consumer_static"))

    def test_the_examples_are_built_as_they_lie_there(self):
        build = self.work / "examples"
        output(CMAKE, "-S", self.root / "usr/share/doc/libproofmass-dev/examples", "-B", build, "-G", "Ninja",
               f"-DCMAKE_PREFIX_PATH={self.root}/usr", f"-DCMAKE_CXX_COMPILER={COMPILER}")  # fmt: skip
        output(CMAKE, "--build", build, "--target", "example_06_fit_a_curve")
        self.assertNotEqual(output(build / "example_06_fit_a_curve", env=self.loader), "")

    def test_nothing_knows_where_it_was_built(self):
        places = [str(place).encode() for place in (BUILD, SOURCE / "src", SOURCE / "apps", self.work)]
        for path in self.root.rglob("*"):
            if path.is_file() and not path.is_symlink():
                data = path.read_bytes()
                for place in places:
                    self.assertNotIn(place, data, path)
        for path in ("usr/bin/proofmass", "usr/lib/libproofmass.so.0.1"):
            self.assertNotRegex(output("objdump", "-p", self.root / path), "R(UN)?PATH")


if __name__ == "__main__":
    unittest.main()
