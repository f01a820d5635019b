"""Random choices that a seed decides, the same ones with every version of Python."""
import math
import random


class Draw:
    def __init__(self, *key):
        # Of the generator only random() is used: what the other methods make of it changes between versions.
        self.random = random.Random('/'.join(map(str, key))).random

    def chance(self, probability):
        return self.random() < probability

    def uniform(self, least, most):
        return least + (most - least) * self.random()

    def log_uniform(self, least, most):
        return math.exp(self.uniform(math.log(least), math.log(most)))

    def whole(self, least, most):
        return least + int((most - least + 1) * self.random())

    def log_whole(self, least, most):
        return int(self.log_uniform(least, most + 1))

    def normal(self):
        return math.sqrt(-2 * math.log(1 - self.random())) * math.cos(2 * math.pi * self.random())

    def pick(self, choices):
        return choices[int(self.random() * len(choices))]

    def weighted(self, choices):
        """One of the keys of a table of weights."""
        left = self.random() * sum(choices.values())
        for choice, weight in choices.items():
            left -= weight
            if left < 0:
                return choice
        return choice

    def ranged(self, choices):
        """A whole number from one of the ranges (least, most) of a table of weights."""
        return self.whole(*self.weighted(choices))

    def shuffled(self, choices):
        rest = list(choices)
        return [rest.pop(int(self.random() * len(rest))) for _ in range(len(rest))]

    def some(self, choices, count):
        return self.shuffled(choices)[:count]

    def sign(self):
        return 1 if self.chance(0.5) else -1


def number(value, digits=5):
    """As short as people write it, and never in a form that the languages do not read."""
    text = f'{value:.{digits}g}'
    return '0' if float(text) == 0 else text


def numbers(values, between=', ', digits=5):
    return between.join(number(value, digits) for value in values)
