"""Questionnaires of studies with people: their items, scales and scores. Item texts are short labels of our own for each
published item, since some publishers license the wording.

NASA-TLX: six scales of 21 ticks, 0 to 100 in steps of 5 (Hart and Staveland 1988); raw TLX is their mean (Hart 2006). Weighted: of
each of the 15 pairs of scales, the one that mattered more; a scale weighs as often as it was chosen, and the weights' sum is 15.
SSQ: 16 symptoms, 0 to 3; nausea, oculomotor, disorientation, total by Kennedy et al. 1993, table 5.
presence: six items of 1 to 7; the mean, and how many are 6 or 7 (Slater, Usoh and Steed 1994).
trust: twelve items of 1 to 7, the first five reversed; the mean (Jian, Bisantz and Drury 2000).
"""
import itertools

from scenario import Refused, check_keys, text_of, _number

TLX = ["mental demand", "physical demand", "temporal demand", "performance (0 perfect, 100 failure)", "effort", "frustration"]
SSQ = ["general discomfort", "fatigue", "headache", "eye strain", "difficulty focusing", "salivation increasing", "sweating",
       "nausea", "difficulty concentrating", "fullness of the head", "blurred vision", "dizziness with eyes open",
       "dizziness with eyes closed", "vertigo", "stomach awareness", "burping"]
# The symptoms that count for nausea, oculomotor, disorientation, in the order above (Kennedy et al. 1993).
NAUSEA, OCULOMOTOR, DISORIENTATION = (0, 5, 6, 7, 8, 14, 15), (0, 1, 2, 3, 4, 8, 10), (4, 7, 9, 10, 11, 12, 13)
PRESENCE = ["sense of being in the place", "moments when it was reality for me", "a place I visited, not pictures I saw",
            "stronger sense of being there than elsewhere", "memory of it like memory of a place",
            "I thought I was really there"]
TRUST = ["the robot is deceptive", "it behaves underhandedly", "I am suspicious of it", "I am wary of it",
         "its action will harm", "I am confident in it", "it gives security", "it has integrity", "it is dependable",
         "it is reliable", "I can trust it", "I am familiar with it"]


def score_tlx(a):
    return {"tlx_raw": sum(a) / 6}


def score_tlx_weighted(a):
    ratings, choices = a[:6], a[6:]
    weights = [0] * 6
    for pair, chosen in zip(TLX_PAIRS, choices):
        weights[pair[chosen - 1]] += 1
    return score_tlx(ratings) | {"tlx_weighted": sum(w * r for w, r in zip(weights, ratings)) / len(TLX_PAIRS)}


def score_ssq(a):
    n, o, d = (sum(a[i] for i in of) for of in (NAUSEA, OCULOMOTOR, DISORIENTATION))
    return {"ssq_nausea": 9.54 * n, "ssq_oculomotor": 7.58 * o, "ssq_disorientation": 13.92 * d, "ssq_total": 3.74 * (n + o + d)}


def score_presence(a):
    return {"presence_mean": sum(a) / len(a), "presence_high": float(sum(v >= 6 for v in a))}


def score_trust(a):
    turned = [8 - v if i < 5 else v for i, v in enumerate(a)]
    return {"trust_mean": sum(turned) / len(turned)}


class Form:
    """A questionnaire: items of (text, least, most, step), words about the ends of the scale, and score(answers), a dict of numbers."""

    def __init__(self, title, items, ends, score):
        self.title, self.items, self.ends, self.score = title, items, ends, score

    def check(self, item, text):
        """The number that a participant typed, or a line that says what is accepted."""
        _, low, high, step = self.items[item]
        told = f"accepted: {low} to {high} in steps of {step}, back, skip"
        try:
            value = int(text.strip())
        except ValueError:
            return None, f"found \"{text.strip()}\"; {told}"
        if not low <= value <= high or (value - low) % step:
            return None, f"found {value}; {told}"
        return value, None

    def score_names(self):
        return list(self.score([low for _, low, _, _ in self.items]))

    def scores(self, answers):
        """None where an answer was declined: a score of what is left would not be the published one."""
        return None if None in answers else self.score(answers)


def _scaled(items, low, high, step=1):
    return [(text, low, high, step) for text in items]


TLX_PAIRS = list(itertools.combinations(range(6), 2))
_RATINGS = _scaled(TLX, 0, 100, 5)
_SHORT = [text.partition(" (")[0] for text in TLX]
FORMS = {
    "nasa_tlx": Form("Workload (NASA-TLX)", _RATINGS, "0 low, 100 high", score_tlx),
    "nasa_tlx_weighted": Form("Workload (NASA-TLX)",
                              _RATINGS + _scaled([f"which mattered more: {_SHORT[a]} (1) or {_SHORT[b]} (2)?" for a, b in TLX_PAIRS], 1, 2),
                              "0 low, 100 high; then pairs of what you rated", score_tlx_weighted),
    "ssq": Form("How you feel now (SSQ)", _scaled(SSQ, 0, 3), "0 none, 1 slight, 2 moderate, 3 severe", score_ssq),
    "presence": Form("Presence (SUS)", _scaled(PRESENCE, 1, 7), "1 not at all, 7 very much", score_presence),
    "trust": Form("Trust in the robot", _scaled(TRUST, 1, 7), "1 not at all, 7 extremely", score_trust),
}


def own(where, table):
    """{name: Form} of a plan's [questionnaires.NAME]: title, items, least, most, step, ends, reversed (numbers of items, from 1). Its
    score, NAME_mean, is the mean, where a reversed answer counts from the other end."""
    if not isinstance(table, dict):
        raise Refused(f"{where}: found {table!r}; accepted: tables, each [{where.split()[-1]}.NAME]")
    made = {}
    for name, about in table.items():
        at = f"{where}.{name}"
        if name in FORMS or not name.replace("_", "").isalnum():
            raise Refused(f"{at}: found {name!r}; accepted: a new word of letters, digits, _, not {', '.join(FORMS)}")
        check_keys(at, about, ["title", "items", "least", "most", "step", "ends", "reversed"])
        items, turned = about.get("items"), about.get("reversed", [])
        if not isinstance(items, list) or not items or not all(isinstance(i, str) and i.strip() for i in items):
            raise Refused(f"{at}.items: found {items!r}; accepted: a list of texts, one a question")
        low = _number(f"{at}.least", about.get("least", 1), -1000, 1000, True)
        high = _number(f"{at}.most", about.get("most", 7), low + 1, 1_000_000, True)
        step = _number(f"{at}.step", about.get("step", 1), 1, high - low, True)
        if (high - low) % step:
            raise Refused(f"{at}.step: found {step}; accepted: one that leads from {low} to {high}")
        if not isinstance(turned, list) or not all(type(i) is int and 1 <= i <= len(items) for i in turned):
            raise Refused(f"{at}.reversed: found {turned!r}; accepted: a list of numbers from 1 to {len(items)}")
        made[name] = Form(text_of(at, about, "title", name), _scaled(items, low, high, step), text_of(at, about, "ends", f"{low} to {high}"),
                          _mean_of(f"{name}_mean", set(turned), low + high))
    return made


def _mean_of(name, turned, ends_sum):
    return lambda a: {name: sum(ends_sum - v if i in turned else v for i, v in enumerate(a, 1)) / len(a)}


def latin_square(n):
    """Rows of orders in which each condition stands once at each place and, for even n, follows each other one once
    (Williams 1949); for odd n from 3 on the mirrored rows follow, so that both hold over 2 n rows."""
    first = [0]
    for k in range(1, n):
        first.append((k + 1) // 2 if k % 2 else n - k // 2)
    rows = [[(v + i) % n for v in first] for i in range(n)]
    return rows if n % 2 == 0 or n == 1 else rows + [row[::-1] for row in rows]
