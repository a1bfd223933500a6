"""What the peers written in Python share: the lattice, and the conversation with `aspic bench` (README.md)."""
import argparse
import json
import math
import os
import sys
import time

import numpy

# Libraries greet on standard output, which is for the conversation.
answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)


def offsets():
    """The springs of a particle to neighbors of higher index: docs/physics.md, section 2."""
    result = []
    for i in range(3):
        for j in range(-2, 3):
            for k in range(-2, 3):
                squares = i * i + j * j + k * k
                straight = squares == 4 and [i, j, k].count(0) == 2
                if (i, j, k) > (0, 0, 0) and (squares <= 3 or straight):
                    result.append((i, j, k))
    return result


class Lattice:
    def __init__(self, arguments):
        self.__dict__.update(vars(arguments))
        self.spacing = self.edge / (self.size - 1)

    def positions(self, factor):
        """[n³, 3] in m; `factor` stretches along y."""
        along = numpy.arange(self.size) * self.spacing - self.edge / 2
        i, j, k = numpy.meshgrid(along, self.height + factor * along, along, indexing="ij")
        return numpy.stack([i.ravel(), j.ravel(), k.ravel()], axis=1)

    def start(self):
        return self.positions(self.stretch)

    def springs(self):
        """Index pairs [s, 2] and rest lengths [s], in ascending first index."""
        n = self.size
        index = numpy.arange(n**3).reshape(n, n, n)
        pairs, lengths = [], []
        for offset in offsets():
            low = tuple(slice(max(0, -o), n - max(0, o)) for o in offset)
            high = tuple(slice(max(0, o), n - max(0, -o)) for o in offset)
            a, b = index[low].ravel(), index[high].ravel()
            pairs.append(numpy.stack([a, b], axis=1))
            lengths.append(numpy.full(len(a), self.spacing * math.sqrt(sum(o * o for o in offset))))
        pairs, lengths = numpy.concatenate(pairs), numpy.concatenate(lengths)
        order = numpy.argsort(pairs[:, 0], kind="stable")
        return pairs[order], lengths[order]


def converse(make):
    """make(lattice) gives an object with hello(), springs, load(), advance(steps), which waits for the end, and
    positions() [n³, 3]."""
    parser = argparse.ArgumentParser(description="A peer of aspic bench: bench/peers/README.md")
    parser.add_argument("--size", type=int, required=True)
    parser.add_argument("--threads", type=int, required=True)
    for name in ("edge", "height", "mass", "stiffness", "damping", "timestep", "gravity", "stretch"):
        parser.add_argument("--" + name, type=float, required=True)
    lattice = Lattice(parser.parse_args())

    def say(line):
        answers.write(json.dumps(line) + "\n")
        answers.flush()

    peer = make(lattice)
    say({**peer.hello(), "springs": peer.springs})
    for line in sys.stdin:
        word, steps = line.split()
        peer.load()
        start, processor_start = time.perf_counter(), time.process_time()
        peer.advance(int(steps))
        seconds, processor_seconds = time.perf_counter() - start, time.process_time() - processor_start
        x = numpy.asarray(peer.positions(), dtype=numpy.float64)
        answer = {"seconds": seconds, "processor_seconds": processor_seconds, "height": float(x[:, 1].mean())}
        if word == "positions":
            answer["positions"] = x.ravel().tolist()
        say(answer)
