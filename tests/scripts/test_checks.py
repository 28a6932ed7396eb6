"""Tests of the checks in scripts/. Each case is a small source tree with one violation."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
sys.dont_write_bytecode = True
import check_includes  # noqa: E402
import check_style  # noqa: E402
import summarise_tests  # noqa: E402


class Tree(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text)


class Includes(Tree):
    def offences(self):
        return list(check_includes.offences(self.root))

    def test_lower_and_own_folder_are_allowed(self):
        self.write("src/tracking/a.cpp", '#include "tracking/a.h"\n#include "core/se3.h"\n#include <render/x.h>\n')
        self.write("apps/main.cpp", '#include "system/pipeline.h"\n#include "command.h"\n')
        self.assertEqual(self.offences(), [])

    def test_higher_is_refused(self):
        self.write("src/core/a.h", '\n  #  include "mapping/voxel.h"\n')
        self.assertEqual(len(self.offences()), 1)
        self.assertIn("src/core/a.h:2", self.offences()[0])

    def test_same_rank_is_refused(self):
        self.write("src/io/a.h", '#include "mapping/voxel.h"\n')
        self.assertEqual(len(self.offences()), 1)

    def test_relative_paths_and_unknown_folders_are_refused(self):
        self.write("src/core/a.h", '#include "../mapping/voxel.h"\n')
        self.write("src/util/a.h", "\n")
        self.assertEqual(len(self.offences()), 2)


class Style(Tree):
    def test_long_files_warn_then_fail(self):
        self.write("src/core/a.cpp", "\n" * 250)
        self.write("src/core/b.cpp", "\n" * 251)
        self.write("src/core/c.cpp", "\n" * 501)
        self.assertEqual([failure for failure, _ in check_style.findings(self.root)], [False, True])

    @unittest.skipIf(check_style.formatter() is None, "needs clang-format-14")
    def test_unformatted_files_are_found(self):
        self.write(".clang-format", "BasedOnStyle: Google\n")
        self.write("src/core/a.cpp", "int a = 1;\n")
        self.write("src/core/b.cpp", "int  b =1;\n")
        found = list(check_style.format_findings(self.root))
        self.assertEqual([failure for failure, _ in found], [True])
        self.assertIn("src/core/b.cpp", found[0][1])

    def test_heavy_includes_only_in_sources(self):
        self.write("src/io/a.h", "#include <opencv2/core.hpp>\n")
        self.write("src/io/a.cpp", "#include <opencv2/core.hpp>\n")
        self.assertEqual(len(list(check_style.findings(self.root))), 1)

    def test_constants_are_unique_in_a_folder(self):
        self.write("src/io/a.cpp", "constexpr float kOne = 1, kTwo[] = {2, 3};\nconstexpr Pair kThree{\n    1, 2};\n"
                                   "void F() {\n    constexpr int kLocal = 1;\n}\n")
        self.write("src/io/b.cpp", "// constexpr int kOne = 1;\nvoid G() {\n    constexpr int kLocal = kTwo[0];\n}\n")
        self.write("src/core/c.cpp", "constexpr float kOne = 1;\n")
        self.write("apps/c.cpp", "constexpr float kOne = 1;\n")
        self.write("tests/io/d.cpp", "constexpr float kOne = 1;\n")
        self.write("tests/io/e.cpp", "constexpr float kOne = 1;\n")
        self.assertEqual(list(check_style.constant_findings(self.root)), [])
        self.write("src/io/d.cpp", "constexpr int kTwo[1] = {1};\n\nconstexpr int kThree = 3;\n")
        self.write("apps/d.cpp", "constexpr float kOne = 1;\n")
        self.assertEqual([text for _, text in check_style.constant_findings(self.root)],
                         ["src/io/d.cpp: kTwo is also in a.cpp", "src/io/d.cpp: kThree is also in a.cpp",
                          "apps/d.cpp: kOne is also in c.cpp"])


class Summary(Tree):
    def test_counts_programs_by_their_tests_and_scripts_by_their_entry(self):
        self.write("s/ctest.xml", '<testsuite><testcase name="script" status="run"/>'
                                  '<testcase name="absent" status="notrun"><skipped/></testcase>'
                                  '<testcase name="broken" status="fail"><failure/><system-out>why</system-out></testcase>'
                                  '<testcase name="program" status="fail"><failure/></testcase></testsuite>')
        self.write("s/program.xml", '<testsuites><testsuite><testcase name="A" classname="C" status="run"/>'
                                    '<testcase name="B" classname="C" status="run"><failure message="b is not 2"/></testcase>'
                                    '<testcase name="D" classname="C" status="run"><skipped message="no data"/></testcase>'
                                    '<testcase name="E" classname="C" status="notrun"/></testsuite></testsuites>')
        results = summarise_tests.read_stage(self.root / "s")
        self.assertEqual(results.passed, 2)
        self.assertEqual(results.failed, {"broken": "why", "C.B": "b is not 2"})
        self.assertEqual(results.skipped, ["absent", "C.D", "C.E"])

    def test_a_program_that_ends_badly_has_failed_although_its_tests_passed(self):
        self.write("s/ctest.xml", '<testsuite><testcase name="program" status="fail"><failure/>'
                                  '<system-out>leak</system-out></testcase>'
                                  '<testcase name="crashed" status="fail"><failure/></testcase></testsuite>')
        self.write("s/program.xml", '<testsuites><testcase name="A" classname="C" status="run"/></testsuites>')
        results = summarise_tests.read_stage(self.root / "s")
        self.assertEqual((results.passed, results.failed), (1, {"program": "leak", "crashed": ""}))

    def test_a_stage_that_is_missing_or_empty_has_failed(self):
        self.assertEqual(summarise_tests.main([str(self.root / "absent")]), 1)
        self.write("s/ctest.xml", "<testsuite/>")
        self.assertEqual(summarise_tests.main([str(self.root / "s")]), 1)


if __name__ == "__main__":
    unittest.main()
