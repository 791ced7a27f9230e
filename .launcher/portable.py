"""Gathers modules that load where none of our libraries are installed, and beside them the libraries, renamed.

Blender brings other versions of the same libraries into the same process. So each copy has a file name and soname of
its own and finds its fellows in its own folder. Functions whose names do not tell versions apart are called through
what native/python/make_forwards.py writes.
"""
import pathlib
import re
import shutil
import subprocess

# Of the system, as its C library is: there is one of each in a process, and newer ones do what older ones did.
SYSTEM = re.compile(r"(linux-vdso|ld-linux-x86-64|lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+|z))\.so(\.\d+)*$")
NEWEST = {"GLIBC": (2, 35), "GLIBCXX": (3, 4, 30)}  # a little less than Debian 12 has
FOLDER = "libraries"


class Refused(Exception):
    """The modules would not load where they are meant to; the message is one sentence."""


def run(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def needed(path):
    """The sonames that a library or module names."""
    return re.findall(r"\(NEEDED\).*\[(.+)\]", run("readelf", "--dynamic", "--wide", path))


def found(module):
    """{soname: file} of all that this machine loads with a module."""
    return {name: pathlib.Path(path).resolve()
            for name, path in re.findall(r"^\s*(\S+) => (/\S+)", run("ldd", module), re.MULTILINE)}


def own_name(soname):
    """libImath-3_1.so.29 -> libmesograin-Imath-3_1.so"""
    return re.sub(r"^lib(.+?)\.so.*", r"libmesograin-\1.so", soname)


def require_old_enough(path):
    for name, *version in re.findall(r"\b(GLIBC|GLIBCXX)_(\d+)\.(\d+)(?:\.(\d+))?\b", run("objdump", "-T", path)):
        numbers = tuple(int(number) for number in version if number)
        if numbers > NEWEST[name]:
            wanted = ".".join(map(str, numbers))
            raise Refused(f"{path.name} needs {name} {wanted}, which is too new; make the zip on Debian 12")


def require_carried(path, target):
    missing = [soname for soname in needed(path)
               if not SYSTEM.match(soname) and not (target / FOLDER / soname).exists()]
    if missing:
        raise Refused(f"{path.name} still needs {', '.join(missing)} of this machine")


def rename(path, carried, origin):
    """Has a copy ask for the renamed ones, in a folder. One call each: patchelf 0.14 mixes up the words of several."""
    for soname in needed(path):
        if soname in carried:
            run("patchelf", "--replace-needed", soname, own_name(soname), path)
    run("patchelf", "--set-rpath", origin, path)


def gather(modules, target):
    """Fills the folder `target` with copies of the modules and what they need of this machine."""
    shutil.rmtree(target, ignore_errors=True)
    (target / FOLDER).mkdir(parents=True)
    carried = {soname: path for module in modules for soname, path in found(module).items()
               if not SYSTEM.match(soname)}
    for soname, path in carried.items():
        copy = pathlib.Path(shutil.copyfile(path, target / FOLDER / own_name(soname)))
        run("patchelf", "--set-soname", copy.name, copy)
        rename(copy, carried, "$ORIGIN")
        shutil.copyfile(licence_of(path), copy.with_suffix(".copyright.txt"))
    for module in modules:
        copy = pathlib.Path(shutil.copy(module, target / module.name))
        run("strip", "--strip-unneeded", copy)  # afterwards it would undo the renaming
        rename(copy, carried, f"$ORIGIN/{FOLDER}")
    for copy in target.rglob("*.so"):
        require_carried(copy, target)
        require_old_enough(copy)
    return sorted(path for path in target.rglob("*") if path.is_file())


def licence_of(path):
    """What Debian says of who wrote a library."""
    package = run("dpkg-query", "--search", path).split(":")[0]
    return f"/usr/share/doc/{package}/copyright"
