# How coarse a viewport's first picture after a change is, so that it follows a drag.
import math

# The first picture is to take no longer, where fewer pixels can bring that about: a redraw waits for two thirds of
# that, and Blender's own of a large window takes three times as long where there is no GPU.
FOLLOWING_SECONDS = 0.045
COARSEST = 6
FIRST = 4  # while nothing is known
# A coarse picture is worth drawing that takes no more of a sharp one's time than this, by the quickest of so many.
WORTH = 0.75
MANY = 3
# Times of samples that differ by more than this factor are of different scenes, as a change of model makes them.
SAME = 1.5


class Coarseness:
    """A picture's divisor is how many pixels of the region one of its own is wide and high. What a sample takes is
    taken for proportional to its pixels. From one sharp picture to the next it never becomes finer: beside redraws a
    sample takes now longer, now less, and the picture would flicker."""

    def __init__(self):
        self._sharp = None  # seconds
        self._changed = True  # since the last sharp sample
        self._least = 1  # divisor, since then
        self._coarse = []  # seconds of the samples of such scenes
        self._last = (None, None)  # divisor and seconds of the last sample

    def note(self, divisor, seconds):
        """A sample of this divisor took so long."""
        self._last = (divisor, seconds)
        if divisor == 1:
            self._note_sharp(seconds)
            return
        self._coarse.append(seconds)
        if self._sharp is not None and seconds > SAME * self._sharp:
            self._forget()
        if seconds > 2.0 * FOLLOWING_SECONDS:
            self._least = min(divisor + 1, COARSEST)

    def _note_sharp(self, seconds):
        # Other work of the machine only adds to what a sample takes.
        before = seconds if self._sharp is None else self._sharp
        least = seconds if self._changed else min(before, seconds)
        if not (least <= SAME * before and before <= SAME * least):
            self._forget()
        self._sharp, self._changed, self._least = least, False, 1
        self._coarse = sorted(self._coarse)[:MANY]

    def _forget(self):
        self._sharp, self._coarse = None, []

    def expected(self, divisor):
        """The seconds of another sample of this divisor; None where the last was of another."""
        of, seconds = self._last
        return seconds if of == divisor else None

    def divisor(self):
        """Of the next first picture."""
        self._changed = True
        if self._sharp is None:
            return max(FIRST, self._least)
        if len(self._coarse) >= MANY and min(self._coarse) > WORTH * self._sharp:
            return 1
        wanted = math.ceil(math.sqrt(self._sharp / FOLLOWING_SECONDS))
        return max(min(wanted, COARSEST), self._least)


def finer(divisor):
    """Of the next picture when no change comes. The sharp one alone would take 36 times as long as the coarsest."""
    return divisor // 2


def size(whole, divisor):
    """(width, height) in pixels of a picture of a region of `whole` pixels."""
    return tuple(-(-extent // divisor) for extent in whole)
