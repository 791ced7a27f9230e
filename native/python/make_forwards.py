"""Writes the C++ text by which a portable module calls its own copies of libraries that Blender has, too.

    make_forwards.py OUTPUT.cpp NM ARCHIVE...

The dynamic linker asks Blender's libraries first, by a function's name alone, and Embree 3 and 4 call different
functions by one name. So the module defines each name that its rooms call, hidden, and passes the call on to the
library that it brought.
"""
import pathlib
import re
import subprocess
import sys

# Libraries, and how the names of their functions begin.
LIBRARIES = {"libmesograin-embree3.so": "rtc[A-Z]", "libmesograin-meshoptimizer.so": "meshopt_"}

TEXT = """// Written by make_forwards.py: passes calls on to the libraries that this module brought.
#include <dlfcn.h>

extern "C" {{
__attribute__((visibility("hidden"))) void* mesograin_forwards[{count}];
}}

namespace {{

struct Forward {{
  const char* library;
  const char* name;
}};

constexpr Forward forwards[] = {{
{table}
}};

// They are loaded by now, as the module needs them; a module that was not gathered with them calls what there is.
__attribute__((constructor)) void find_forwards() {{
  for (int i = 0; i < {count}; ++i) {{
    void* library = dlopen(forwards[i].library, RTLD_LAZY | RTLD_NOLOAD);
    mesograin_forwards[i] = dlsym(library != nullptr ? library : RTLD_DEFAULT, forwards[i].name);
  }}
}}

}}  // namespace

asm(R"(
.text
{jumps}
)");
"""


def called(nm, archives):
    """[(library, function)] that the archives call."""
    listed = subprocess.run([nm, "--undefined-only", *archives], capture_output=True, text=True,
                            check=True).stdout
    return [(library, name) for library, start in LIBRARIES.items()
            for name in sorted(set(re.findall(rf" U ({start}\w*)$", listed, re.MULTILINE)))]


def main(output, nm, *archives):
    names = called(nm, archives)
    table = "\n".join(f'    {{"{library}", "{name}"}},' for library, name in names)
    jumps = "\n".join(f".globl {name}\n.hidden {name}\n.type {name}, @function\n{name}:\n"
                      f"  jmp *mesograin_forwards+{8 * at}(%rip)" for at, (_, name) in enumerate(names))
    pathlib.Path(output).write_text(TEXT.format(count=len(names), table=table, jumps=jumps))


if __name__ == "__main__":
    main(*sys.argv[1:])
