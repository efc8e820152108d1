"""Questionnaires of studies with people: their items, scales and scores. Item texts are short labels of our own for each
published item, since some publishers license the wording.

NASA-TLX: six scales of 21 ticks, 0 to 100 in steps of 5 (Hart and Staveland 1988); raw TLX is their mean (Hart 2006).
SSQ: 16 symptoms, 0 to 3; nausea, oculomotor, disorientation, total by Kennedy et al. 1993, table 5.
presence: six items of 1 to 7; the mean, and how many are 6 or 7 (Slater, Usoh and Steed 1994).
trust: twelve items of 1 to 7, the first five reversed; the mean (Jian, Bisantz and Drury 2000).
"""
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


def score_ssq(a):
    n, o, d = (sum(a[i] for i in of) for of in (NAUSEA, OCULOMOTOR, DISORIENTATION))
    return {"ssq_nausea": 9.54 * n, "ssq_oculomotor": 7.58 * o, "ssq_disorientation": 13.92 * d, "ssq_total": 3.74 * (n + o + d)}


def score_presence(a):
    return {"presence_mean": sum(a) / len(a), "presence_high": float(sum(v >= 6 for v in a))}


def score_trust(a):
    turned = [8 - v if i < 5 else v for i, v in enumerate(a)]
    return {"trust_mean": sum(turned) / len(turned)}


# name: (title, items, least, most, step, words at the ends, score)
FORMS = {
    "nasa_tlx": ("Workload (NASA-TLX)", TLX, 0, 100, 5, "0 low, 100 high", score_tlx),
    "ssq": ("How you feel now (SSQ)", SSQ, 0, 3, 1, "0 none, 1 slight, 2 moderate, 3 severe", score_ssq),
    "presence": ("Presence (SUS)", PRESENCE, 1, 7, 1, "1 not at all, 7 very much", score_presence),
    "trust": ("Trust in the robot", TRUST, 1, 7, 1, "1 not at all, 7 extremely", score_trust),
}


def check(name, item, text):
    """The number that a participant typed, or a line that says what is accepted."""
    _, _, low, high, step, _, _ = FORMS[name]
    try:
        value = int(text.strip())
    except ValueError:
        return None, f"found \"{text.strip()}\"; accepted: {low} to {high} in steps of {step}"
    if not low <= value <= high or (value - low) % step:
        return None, f"found {value}; accepted: {low} to {high} in steps of {step}"
    return value, None


def latin_square(n):
    """Rows of orders in which each condition stands once at each place and, for even n, follows each other one once
    (Williams 1949); for odd n the mirrored rows follow, so that both hold over 2 n rows."""
    first = [0]
    for k in range(1, n):
        first.append((k + 1) // 2 if k % 2 else n - k // 2)
    rows = [[(v + i) % n for v in first] for i in range(n)]
    return rows if n % 2 == 0 else rows + [row[::-1] for row in rows]
