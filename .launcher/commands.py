"""The commands: what each understands, what must be there for it, and how it is run. See `Command`.

Words are read by the parser of whoever runs them in the end, so that help and complaints are its own.
"""
import argparse
import contextlib
import os
import pathlib
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "addon"))

from mesograin.command_line.parser import Parser  # noqa: E402
from mesograin.studies.animation import arguments as animate_arguments  # noqa: E402
from mesograin.studies.baking import arguments as bake_arguments  # noqa: E402
from mesograin.studies.comparison import arguments as compare_arguments  # noqa: E402
from mesograin.studies.match import arguments as match_arguments  # noqa: E402
from mesograin.studies.sweep import arguments as sweep_arguments  # noqa: E402
from mesograin.studies.trade import arguments as trade_arguments  # noqa: E402

from pictures import PICTURES  # noqa: E402

PARTS = {
    "lint": "formatting, static analysis, shader validation, shell scripts, what every file must keep to",
    "physics": "the physics library against itself in double precision and against independent oracles",
    "native": "the native module's rooms, and again under the address and undefined-behaviour sanitizers",
    "python": "the Python module and the report, without Blender",
    "blender": "the add-on inside a Blender without a window",
    "window": "the add-on in a real Blender window on a virtual screen",
}
BENCHMARKS = {
    "frame": "what each model costs relative to lambert: shade pass alone, 400x400, sphere, two lights",
    "heap": "what heaps of a thousand to a million grains cost relative to one lambert sphere, and how much memory",
    "reading": "how long Blender's main thread reads a hundred thousand scattered grains",
    "drag": "how long a change takes to be seen in a real window, relative to Blender's own redraw in Solid shading",
    "exchange": "what light between grains costs while a scene changes: milliseconds to the first and the final answer",
    "heap_light": "how far light between grains is from path tracing, for kinds and lights; about half an hour",
    "chance_heaps": "how far light between grains is from path tracing, for heaps by chance; minutes each",
    "dual_scattering": "what dual scattering makes of light between grains, beside what is solved and path tracing",
    "accuracy": "how far each model's sphere is from photon Monte Carlo; about twelve minutes",
    "relightable": "how far a relightable bake is from bakes for each light, by its number of components",
    "shapes": "how far pictures of grains of any shape are from photon Monte Carlo, such as tests/data/shapes holds",
    "match": "how near a match comes to the coefficients of Cycles' pictures: a sphere, sand, a heap",
    "transport": "how long the model transport takes to answer for a new mesh, and after a slider",
    "programs": "what compiled programs cost of memory, and whether it rests while more are needed",
    "false_alarms": "how often the significance test calls renders different that differ in their seed alone",
}

TRACED = ("heap_light", "chance_heaps", "dual_scattering")  # beside their truth


class Place:
    """Where things are, as the shell that made sure of them says."""

    def __init__(self):
        self.build = os.environ["LAUNCHER_BUILD"]
        self.logs = os.environ["LAUNCHER_LOGS"]
        self.python = os.environ.get("LAUNCHER_PYTHON", "")
        self.blender = os.environ.get("MESOGRAIN_BLENDER", "")
        self.blender_version = os.environ.get("LAUNCHER_BLENDER_VERSION", "")
        self.root_summaries = os.environ.get("LAUNCHER_ROOT_SUMMARIES", "").splitlines()

    def in_blender(self, log, script, *words, factory=True):
        """What runs a script inside Blender, its chatter in a log."""
        return ["/usr/bin/python3", SOURCE / ".launcher/run_blender.py", f"{self.logs}/{log}.log", self.blender,
                "--background", *(["--factory-startup"] if factory else []), "--python-exit-code", "1",
                "--python", SOURCE / script, "--", *words]


class Command:
    """One command. sentence: what it does, for the overview. about, epilog: for its own help."""

    name = ""
    sentence = ""
    about = ""
    epilog = None

    def parser(self):
        """Its parser, without what the shell understands."""
        return Parser(prog=f"./mesograin {self.name}", description=self.about, epilog=self.epilog,
                      formatter_class=argparse.RawDescriptionHelpFormatter)

    def named(self, asked, kind, known):
        """What was asked for, all that is known if nothing. Ends the process with a sentence if some is not known."""
        for name in asked:
            if name not in known:
                self.parser().error(f"there is no {kind} '{name}'; the {kind}s are {', '.join(known)}")
        return asked or list(known)

    def wants_help(self, words):
        """Whether the words ask for help that is not a program's own."""
        return bool({"--help", "-h"} & set(words[:words.index("--")] if "--" in words else words))

    def help(self):
        """Prints what there is to know."""
        parser = self.parser()
        with contextlib.suppress(argparse.ArgumentError):  # one has it already
            parser.add_argument("--blender", metavar="PATH",
                                help="the Blender to use (default: MESOGRAIN_BLENDER, or blender on the PATH)")
        parser.print_help()

    def check(self, words):
        """What must be there, a line each. Ends the process with a sentence and exit code 2 if the words are wrong."""
        raise NotImplementedError

    def run(self, words, place):
        """The program to become, with its arguments."""
        raise NotImplementedError


class InBlender(Command):
    """A command of the add-on that takes a scene, by default the sphere."""

    def __init__(self, name, sentence, room, arguments):
        self.name, self.sentence = name, sentence
        self._room, self._arguments = room, arguments

    def parser(self):
        return self._arguments.build()

    def check(self, words):
        self._arguments.parse(words)
        return ["blender", "lists report", "product product", *_referee(words)]

    def run(self, words, place):
        chosen = self._arguments.parse(words)
        scene = [] if chosen.scene else [SOURCE / "blend_files/sphere.blend"]
        return place.in_blender(self.name, f"addon/mesograin/studies/{self._room}/command.py", *scene, *words)


class Sweep(Command):
    name, sentence = "sweep", "compare many cases that a TOML file lists, on one machine or many"

    def parser(self):
        return sweep_arguments.build()

    def check(self, words):
        chosen = sweep_arguments.build().parse_args(words)
        file = pathlib.Path(chosen.file)
        asked = file.read_text(errors="replace") if file.is_file() else ""
        return ["blender", "lists report", "product product", *_referee(["photon"] if "photon" in asked else [])]

    def run(self, words, place):
        return [place.python, SOURCE / "addon/mesograin/studies/sweep/command.py", *words, "--blender", place.blender]


class Animate(Command):
    name, sentence = "animate", "render the frames of an animation that are missing, on one machine or many"

    def parser(self):
        return animate_arguments.build()

    def check(self, words):
        animate_arguments.build().parse_args(words)
        return ["blender", "product product"]

    def run(self, words, place):
        command = SOURCE / "addon/mesograin/studies/animation/command.py"
        return ["/usr/bin/python3", command, *words, "--blender", place.blender]


class Render(Command):
    """The renderer's own command line; its help is the program's, once there is one."""

    name, sentence = "render", "render a scene described in JSON to EXR, without Blender"

    def help(self):
        tool = pathlib.Path(os.environ["LAUNCHER_BUILD"]) / "native/tool/mesograin-render"
        print(f"./mesograin {self.name} runs mesograin-render.\n", flush=True)
        if tool.exists():
            os.execv(tool, [str(tool), "--help"])
        print(f"It is there to {self.sentence}; it tells its options once it is built: ./mesograin build.")

    def check(self, words):
        if not words:
            self.parser().error("a scene and an output are needed: ./mesograin render SCENE.json -o OUT.exr")
        return ["any_python", "product product"]

    def run(self, words, place):
        return [f"{place.build}/native/tool/mesograin-render", *words]


class Bake(Command):
    name, sentence = "bake", "bake a grain's surface to an EXR texture, and Cycles' beside it"

    def parser(self):
        made = bake_arguments.build()
        made.epilog += " A scene in JSON needs no Blender and takes the options of ./mesograin render."
        return made

    def check(self, words):
        if words and words[0].endswith(".json"):
            return RENDER.check(words)
        bake_arguments.parse(words)
        return ["blender", "product product", *_referee(words)]

    def run(self, words, place):
        if words[0].endswith(".json"):
            return RENDER.run([*words, "--bake"], place)
        return place.in_blender("bake", "addon/mesograin/studies/baking/command.py", *words)


class Match(Command):
    name, sentence = "match", "find the coefficients whose picture is nearest to a given one"

    def parser(self):
        return match_arguments.build()

    def check(self, words):
        chosen = match_arguments.parse(words)[0]
        return ["any_python" if match_arguments.is_json(chosen) else "blender", "lists report", "product product"]

    def run(self, words, place):
        folder = "addon/mesograin/studies/match"
        if match_arguments.is_json(match_arguments.parse(words)[0]):
            return [place.python, SOURCE / folder / "json_command.py", *words]
        return place.in_blender("match", f"{folder}/command.py", *words)


class Test(Command):
    name, sentence = "test", "run the tests"
    about = ("Runs the tests; the last line printed is their sum, `N passed, M failed`.\n\n" +
             "\n".join(f"  {name:<11}{what}" for name, what in PARTS.items()))
    epilog = ("A part that crashes or runs no test counts as a failure. Logs and JUnit files: "
              "build/release/test-results.\nExit code: 0 when all passed, 1 when not.")

    def parser(self):
        made = super().parser()
        made.add_argument("parts", nargs="*", metavar="PART", help="one or more of the above (default: all)")
        made.add_argument("--blender-4", action="append_const", dest="roots", const="debian-13", default=[],
                          help="also run python, blender and window with Blender 4.3 in a Debian 13 root; the first"
                          " time it is set up in the cache folder: a few minutes, 3 GB and root's rights")
        made.add_argument("--blender-5", action="append_const", dest="roots", const="debian-sid",
                          help="the same with the Blender 5 of Debian sid, in a root of its own")
        return made

    def _chosen(self, words):
        chosen = self.parser().parse_args(words)
        chosen.parts = self.named(chosen.parts, "part", PARTS)
        return chosen

    def check(self, words):
        chosen = self._chosen(words)
        needs = ["blender", "lists test", "product all" if {"lint", "physics", "native"} & set(chosen.parts) else
                 "product product"]
        if "native" in chosen.parts:
            needs.append("sanitized tests/native/all")
        if "lint" in chosen.parts:
            needs.append("lists lint")
        inside = [part for part in chosen.parts if part in ("python", "blender", "window")]
        if chosen.roots and not inside:
            self.parser().error("--blender-4 and --blender-5 run python, blender and window; none of these was asked"
                                " for")
        return [*needs, *(f"root_test {root} {' '.join(inside)}" for root in chosen.roots)]

    def run(self, words, place):
        chosen = self._chosen(words)
        also = [word for summary in place.root_summaries for word in ("--also", summary)]
        return ["/usr/bin/python3", SOURCE / ".launcher/run_tests.py", "--build", place.build, "--python", place.python,
                "--blender", place.blender, "--blender-version", place.blender_version,
                "--results", f"{place.build}/test-results", *also, *chosen.parts]


class Bench(Command):
    """Each benchmark is a script with a command line of its own."""

    name, sentence = "bench", "measure speed and accuracy"
    about = ("Measures. Times are given as ratios within one run, so that they mean the same on another machine.\n\n" +
             "\n".join(f"  {name:<17}{what}" for name, what in BENCHMARKS.items()) +
             "\n\n./mesograin bench BENCHMARK --help tells the options of one.")

    def parser(self):
        made = super().parser()
        made.add_argument("benchmark", nargs="?", metavar="BENCHMARK", help="one of the above (default: frame)")
        made.add_argument("options", nargs=argparse.REMAINDER, metavar="option ...", help="of the benchmark")
        return made

    def _chosen(self, words):
        name = words[0] if words and not words[0].startswith("-") else "frame"
        if name not in BENCHMARKS:
            self.parser().error(f"there is no benchmark '{name}'; there are {', '.join(BENCHMARKS)}")
        return name, words[1:] if words[:1] == [name] else words

    def wants_help(self, words):
        return bool(words) and words[0] in ("--help", "-h")

    def check(self, words):
        name, _ = self._chosen(words)
        return ["blender", "lists report", "product product", *(["referee"] if name in TRACED else [])]

    def run(self, words, place):
        name, options = self._chosen(words)
        script = f"tests/bench/{name}.py"
        if name in ("false_alarms", "match", "reading"):
            return place.in_blender("bench", script, *options)
        return [place.python, SOURCE / script, place.build, *options]


class Pictures(Command):
    """Those of the documentation."""

    name, sentence = "pictures", "make the documentation's pictures anew"
    epilog = ("What Cycles renders and photons are traced for stays in the folder and is not made again; without the\n"
              "folder all is made from nothing. Interrupted, the same command goes on.")

    @property
    def about(self):
        lines = (f"  {name:<12}{picture.sentence}" for name, picture in PICTURES.items())
        return ("Makes the documentation's pictures anew, from blend_files and Blender's own scene, and the lines of\n"
                "its pages that tell what was measured in them.\n\n" + "\n".join(lines))

    def parser(self):
        made = super().parser()
        made.add_argument("pictures", nargs="*", metavar="NAME", help="one or more of the above (default: all)")
        made.add_argument("--folder", type=pathlib.Path, default=SOURCE / "build/pictures",
                          help="where what takes long is kept (default: build/pictures)")
        return made

    def _chosen(self, words):
        """(names of pictures, the folder)."""
        chosen = self.parser().parse_args(words)
        return self.named(chosen.pictures, "picture", PICTURES), chosen.folder

    def check(self, words):
        names, _ = self._chosen(words)
        return ["blender", "lists report", "product product", *(["referee"] if "shapes" in names else [])]

    def run(self, words, place):
        names, folder = self._chosen(words)
        script = SOURCE / ".launcher/pictures.py"
        return ["/usr/bin/python3", script, place.build, place.blender, place.logs, folder, *names]


class Build(Command):
    name, sentence = "build", "build the native module, and nothing else"
    about = ("Builds the native module and the command-line renderer; silent when they are up to date. The module\n"
             "lands in build/release and beside the add-on, so that both can import it.")

    def check(self, words):
        self.parser().parse_args(words)
        return ["blender", "product product"]

    def run(self, words, place):
        return ["/bin/true"]


class Package(Command):
    name, sentence = "package", "make a zip of the add-on"
    about = "Makes a zip of the add-on that Blender installs: build/package/mesograin-VERSION.zip."
    epilog = ("The one zip works as an add-on for Blender 3.4 to 4.1 and as an extension for 4.2 and later. Its\n"
              "native modules run on the Debian they were built for; those of a portable one, made on Debian 12, on\n"
              "any x86-64 Linux from glibc 2.35 on, in Blenders with Python 3.11, 3.13 or 3.14.")

    def parser(self):
        made = super().parser()
        made.add_argument("-o", dest="zip", metavar="FILE.zip", help="where the zip goes")
        made.add_argument("--portable", action="store_true",
                          help="for many machines: the libraries are inside; make it on Debian 12")
        made.add_argument("--blender-4", action="append_const", dest="roots", const="debian-13", default=[],
                          help="also build the module for Blender 4.3 of Debian 13, in a root in the cache folder")
        made.add_argument("--blender-5", action="append_const", dest="roots", const="debian-sid",
                          help="the same for the Blender 5 of Debian sid")
        return made

    def check(self, words):
        chosen = self.parser().parse_args(words)
        if chosen.portable and chosen.roots:
            self.parser().error("--portable builds for other Debians' Blenders; leave out --blender-4 and --blender-5")
        portable = ["portable"] if chosen.portable else []
        return ["blender", "product product", *portable, *(f"root_build {root}" for root in chosen.roots)]

    def run(self, words, place):
        chosen = self.parser().parse_args(words)
        portable = ["--portable", place.build] if chosen.portable else []
        return [place.python, SOURCE / ".launcher/package.py", *portable, SOURCE, *([chosen.zip] if chosen.zip else [])]


class Install(Command):
    name, sentence = "install", "install the add-on into Blender and enable it"
    about = "Installs the add-on into the user's Blender and enables it."
    epilog = "Close Blender first: it saves its preferences when it quits."

    def parser(self):
        made = super().parser()
        made.add_argument("--remove", action="store_true", help="take the add-on out again")
        return made

    def check(self, words):
        return ["blender"] if self.parser().parse_args(words).remove else ["blender", "product product"]

    def run(self, words, place):
        if self.parser().parse_args(words).remove:
            return place.in_blender("install", ".launcher/install_addon.py", "--remove", factory=False)
        import package

        zip_file = SOURCE / "build/package/mesograin.zip"
        package.make_zip(SOURCE, zip_file)
        return place.in_blender("install", ".launcher/install_addon.py", zip_file, factory=False)


RENDER = Render()
COMMANDS = {command.name: command for command in (
    InBlender("compare", "render every model and Cycles, measure, write a report", "comparison", compare_arguments),
    InBlender("trade", "measure error against time, for every model and for Cycles", "trade", trade_arguments),
    Sweep(), Animate(), RENDER, Bake(), Match(), Test(), Bench(), Pictures(), Build(), Package(), Install())}


def _referee(words):
    return ["referee"] if {"photon", "photon_scene"} & set(words) else []
