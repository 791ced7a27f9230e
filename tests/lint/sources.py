"""Which files the lint tests look at: those under version control, or about to be."""
import pathlib
import subprocess

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def source_files(*suffixes):
    """Paths relative to the source folder, sorted, with one of the suffixes."""
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=SOURCE, check=True,
                            capture_output=True, text=True).stdout.splitlines()
    return sorted(path for path in set(listed) if path.endswith(suffixes) and (SOURCE / path).is_file())
