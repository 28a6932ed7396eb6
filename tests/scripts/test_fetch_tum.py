"""Tests of scripts/fetch_tum.sh with file:// URLs and no network: complete, resumed, wrong and misnamed downloads."""
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/fetch_tum.sh"
NAME = "rgbd_dataset_freiburg1_desk"


class FetchTum(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.temporary.name)
        self.server, self.to, self.sums = self.root / "server", self.root / "to", self.root / "sums.txt"
        content = self.root / NAME
        content.mkdir()
        (content / "rgb.txt").write_text("# color images\n")
        (content / "depth.bin").write_bytes(os.urandom(100_000))
        (self.server / "freiburg1").mkdir(parents=True)
        self.archive = self.server / f"freiburg1/{NAME}.tgz"
        with tarfile.open(self.archive, "w:gz") as tar:
            tar.add(content, NAME)
        self.content = content

    def tearDown(self):
        self.temporary.cleanup()

    def fetch(self, *arguments, known=None):
        self.sums.write_text(f"{known}  {NAME}.tgz\n" if known else "# none\n")
        environment = dict(os.environ, TESSERA_TUM_URL=f"file://{self.server}", TESSERA_TUM_SUMS=str(self.sums))
        return subprocess.run([SCRIPT, *arguments, "--to", self.to], capture_output=True, text=True, check=False,
                              env=environment)

    def sha256(self):
        return hashlib.sha256(self.archive.read_bytes()).hexdigest()

    def assert_whole(self):
        self.assertEqual((self.to / NAME / "depth.bin").read_bytes(), (self.content / "depth.bin").read_bytes())

    def test_known_checksum(self):
        done = self.fetch("fr1/desk", known=self.sha256())
        self.assertEqual((done.returncode, done.stdout), (0, f"{self.to / NAME}\n"), done.stderr)
        self.assert_whole()
        self.assertEqual([path.name for path in self.to.iterdir()], [NAME])
        self.assertIn("there already", self.fetch(NAME, known=self.sha256()).stdout)

    def test_unknown_checksum_is_written_down(self):
        done = self.fetch("freiburg1_desk")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("not checked", done.stdout)
        self.assertEqual((self.to / f"{NAME}.tgz.sha256").read_text(), f"{self.sha256()}  {NAME}.tgz\n")
        self.assert_whole()

    def test_broken_download_goes_on(self):
        self.to.mkdir()
        part = self.to / f"{NAME}.tgz.part"
        part.write_bytes(self.archive.read_bytes()[:40_000])
        # The start of the file on the server has changed, so only a resumed download gives the right file.
        expected = self.sha256()
        self.archive.write_bytes(bytes(40_000) + self.archive.read_bytes()[40_000:])
        done = self.fetch("fr1/desk", known=expected)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_whole()
        self.assertFalse(part.exists())

    def test_wrong_checksum_is_refused(self):
        done = self.fetch("fr1/desk", known="0" * 64)
        self.assertEqual(done.returncode, 2)
        self.assertIn("not the file expected", done.stderr)
        self.assertFalse((self.to / NAME).exists())

    def test_no_archive_is_refused(self):
        self.archive.write_text("<html>not found</html>")
        done = self.fetch("fr1/desk")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no archive", done.stderr)
        self.assertFalse((self.to / NAME).exists())

    def test_missing_and_misnamed(self):
        for name, expected in (("fr1/none", "cannot be fetched"), ("../etc", "no name of a TUM"),
                               ("--fast", "no such option")):
            done = self.fetch(name)
            self.assertEqual(done.returncode, 2, name)
            self.assertIn(expected, done.stderr)
        self.assertIn("which sequence", self.fetch().stderr)


if __name__ == "__main__":
    if not shutil.which("curl"):
        print("skipped: needs curl")
        sys.exit(77)
    unittest.main()
