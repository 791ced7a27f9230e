# What a Blender in a window has in memory, and who holds it.
"""Debian's Blender 3.4 and 4.3 allocate by jemalloc, 5.2 by TBB's allocator, others by glibc."""

import collections
import ctypes
import gc

LIBRARY = ctypes.CDLL(None)
ALL_ARENAS = 4096  # jemalloc's MALLCTL_ARENAS_ALL
CLEAN_ALL_BUFFERS = 0  # of TBB's scalable_allocation_command: else it keeps hundreds of megabytes that are free


def settled():
    """Resident bytes of this process, once nothing is kept that is free."""
    gc.collect()
    if hasattr(LIBRARY, "mallctl"):
        _check(LIBRARY.mallctl(f"arena.{ALL_ARENAS}.purge".encode(), None, None, None, ctypes.c_size_t(0)))
    elif hasattr(LIBRARY, "scalable_allocation_command"):
        LIBRARY.scalable_allocation_command(ctypes.c_int(CLEAN_ALL_BUFFERS), None)
    else:
        LIBRARY.malloc_trim(0)
    for line in open("/proc/self/status", encoding="ascii"):
        if line.startswith("VmRSS"):
            return 1024 * int(line.split()[1])
    raise AssertionError("Linux does not say VmRSS")


def holders():
    """{what: megabytes}: of mapped files, of code that was made while it ran (shaders, where no GPU draws), and of the
    rest; of this what is allocated now, by anybody in this process (jemalloc alone tells), and the pages in which that
    lies."""
    megabytes = collections.Counter()
    with open("/proc/self/smaps", encoding="ascii", errors="replace") as smaps:
        for line in smaps:
            words = line.split()
            if not words[0].endswith(":"):
                kind = ("files" if len(words) > 5 and words[5].startswith("/") else
                        "made code" if "x" in words[1] else "rest")
            elif words[0] == "Rss:":
                megabytes[kind] += int(words[1]) / 1e3
    if hasattr(LIBRARY, "mallctl"):
        epoch = ctypes.c_uint64(1)  # statistics are those of the moment at which it was written
        _check(LIBRARY.mallctl(b"epoch", None, None, ctypes.byref(epoch), ctypes.c_size_t(ctypes.sizeof(epoch))))
        megabytes.update({"allocated": _statistic("allocated"), "in pages of": _statistic("active")})
    return {kind: round(size) for kind, size in megabytes.items()}


def _statistic(name):
    """Megabytes, as jemalloc(3) says under stats."""
    value, size = ctypes.c_size_t(), ctypes.c_size_t(ctypes.sizeof(ctypes.c_size_t))
    _check(LIBRARY.mallctl(f"stats.{name}".encode(), ctypes.byref(value), ctypes.byref(size), None, ctypes.c_size_t(0)))
    return value.value / 1e6


def _check(code):
    assert code == 0, f"jemalloc answered {code}"
