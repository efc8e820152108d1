"""Shared by all pictures: colours, panels, legends clear of the curves, labels that never collide.

A legend stands above its panel, on the line of the title; where it would reach the title it is set
smaller, then its last entries are left out. A label beside a point takes the first of
the places around the point that hides no other label, and of these the one that hides least of the
curves; where all are taken it is left out.
"""
import matplotlib
import matplotlib.artist

matplotlib.use("Agg")
# Each class of artists would write the help of its settings as it is imported, a quarter of the import's time.
matplotlib.artist.kwdoc = lambda artist: ""
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

# Colours that tell apart for the colour-blind too (Okabe and Ito 2008), darkened where thin on paper.
BLUE, ORANGE, GREEN, PINK, SKY, OCHRE, GREY, BROWN = COLORS = (
    "#0072b2", "#d55e00", "#009e73", "#c06a9c", "#56b4e9", "#b8940a", "#595959", "#803326")
INK, FAINT, PAPER, RED, SAND = "#21262e", "#8a8f98", "#fdfcfa", "#c01a1a", "#b39a6b"
DPI = 100

matplotlib.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 9, "text.color": INK, "axes.labelcolor": INK,
    "axes.edgecolor": "#6a7078", "axes.facecolor": PAPER, "figure.facecolor": PAPER, "axes.linewidth": 0.8,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "axes.axisbelow": True,
    "grid.color": "#d9d9d6", "grid.linewidth": 0.6, "xtick.color": "#4a4f57", "ytick.color": "#4a4f57",
    "xtick.labelsize": 8, "ytick.labelsize": 8, "axes.labelsize": 8.5, "lines.linewidth": 1.4,
    "axes.formatter.useoffset": False, "axes.formatter.limits": (-5, 7), "lines.solid_capstyle": "round", "path.simplify_threshold": 0.3, "agg.path.chunksize": 10000,
    "axes.titley": 1.0,  # no panel has ticks above it, for which all ticks are laid out once more to place its title
})


def color(index):
    return COLORS[index % len(COLORS)]


def numbers(values):
    """A column of the data; null becomes NaN, which is a gap in a line."""
    return np.array([np.nan if v is None else v for v in values], dtype=float)


def figure(width_px, height_px):
    made = Figure(figsize=(width_px / DPI, height_px / DPI), dpi=DPI)
    FigureCanvasAgg(made)
    return made


def area(fig, left, top, right, bottom):
    """A panel whose axes span these pixels, from the picture's upper left corner."""
    width, height = fig.get_size_inches() * DPI
    return fig.add_axes([left / width, 1 - bottom / height, (right - left) / width, (bottom - top) / height])


def short(name, most=24):
    """A name that leaves room for others."""
    return name if len(name) <= most else name[:most - 1] + "…"


def fit(fig, text):
    """Sets a line of text that begins at the page's left margin as small as the page's width asks."""
    room_px = fig.get_size_inches()[0] * DPI - 48
    wide = text.get_window_extent().width
    if wide > room_px:
        text.set_size(text.get_size() * room_px / wide)


def section(fig, top, words):
    """A headline above a row of panels that begins there, in pixels."""
    width, height = fig.get_size_inches() * DPI
    fig.text(24 / width, 1 - (top - 16) / height, words, size=12, weight="bold", color=INK)


def heading(fig, title, lines=(), warnings=()):
    """The picture's title, lines of facts and red warnings; returns how many pixels they take."""
    width, height = fig.get_size_inches() * DPI
    fit(fig, fig.text(24 / width, 1 - 30 / height, title, size=15, weight="bold", va="baseline"))
    y = 30
    for words, hue in [(w, "#50555e") for w in lines] + [("WARNING: " + w, RED) for w in warnings]:
        y += 19
        fit(fig, fig.text(24 / width, 1 - y / height, words, size=9.5, color=hue, va="baseline"))
    return y + 14


def title(ax, words, size=9.5):
    ax.set_title(words, loc="left", size=size, weight="bold", pad=6)


def legend(ax, size=8, handles=None, handle=1.4):
    """On the title's line, from the right. What has no room there stands in columns within the panel, where it hides least:
    no entry is left out."""
    handles = handles if handles is not None else ax.get_legend_handles_labels()[0]
    handles = [h for h in handles if not h.get_label().startswith("_")]
    if not handles:
        return
    looks = {"handles": handles, "handlelength": handle, "columnspacing": 0.8, "handletextpad": 0.5, "borderpad": 0.1,
             "labelspacing": 0.15}
    title_right, wanted = ax._left_title.get_window_extent().x1, size
    while size >= min(7, wanted):
        made = ax.legend(loc="lower right", bbox_to_anchor=(1.005, 1.0), ncol=len(handles), frameon=False, fontsize=size,
                         borderaxespad=0.15, **looks)
        if made.get_window_extent().x0 > title_right + 6:
            return
        made.remove()
        size -= 0.5
    panel = ax.get_window_extent()
    for columns in range(1, len(handles) + 1):  # as narrow as half of the panel's height allows
        made = ax.legend(loc="best", ncol=columns, frameon=True, framealpha=0.8, edgecolor="none", fontsize=min(7.5, wanted),
                         borderaxespad=0.4, **looks)
        made.set_zorder(30)
        box = made.get_window_extent()
        more = box.width * (columns + 1) / columns < panel.width - 8 and columns < len(handles)
        if box.height <= 0.5 * panel.height or not more:
            return
        made.remove()


def plain_log(axis):
    """Ticks of a logarithmic axis as plain numbers where they are short: 0.01, 1, 100, else 1e-5."""
    axis.set_major_locator(LogLocator(base=10, numticks=9))
    axis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
    low, high = sorted(axis.get_view_interval())
    if high / max(low, 1e-300) < 300:  # few decades: 2 and 5 too
        axis.set_major_locator(LogLocator(base=10, subs=(1, 2, 5), numticks=12))
    axis.set_minor_formatter(NullFormatter())


def time_axis(ax, seconds, label=True):
    """Seconds up to ten minutes, then minutes; the data stays in seconds. Ticks as the width allows."""
    ax.set_xlim(0, max(seconds, 0.1))
    most = int(np.clip(ax.get_window_extent().width / 60, 2, 8))
    if seconds <= 600:
        ax.xaxis.set_major_locator(MaxNLocator(most))
        if label:
            ax.set_xlabel("time, s")
        return
    minutes = MaxNLocator(most, steps=[1, 2, 5, 10]).tick_values(0, seconds / 60)
    ax.set_xticks([60 * m for m in minutes if 60 * m <= seconds])
    ax.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v / 60:g}"))
    if label:
        ax.set_xlabel("time, min")


def room(ax, values, least, below=0.06, above=0.08):
    """Limits of y that hold all values with some room, over at least this span."""
    values = np.concatenate([np.atleast_1d(v) for v in values]) if len(values) else np.zeros(0)
    values = values[np.isfinite(values)]
    low, high = (values.min(), values.max()) if len(values) else (0.0, 0.0)
    if high - low < least:
        middle = 0.5 * (low + high)
        low, high = middle - 0.5 * least, middle + 0.5 * least
        if values.size and values.min() >= 0 and low < 0:
            low, high = 0.0, least
    span = high - low
    ax.set_ylim(low - below * span, high + above * span)


def gaps(time, flags):
    """(from, length) of each time over which a flag holds. A row tells of the time since the row before, as the program
    counts: what follows a flagged row, perhaps hours without one, is not its own."""
    out, since = [], None
    for i, flag in enumerate(flags):
        if flag and since is None:
            since = time[max(i - 1, 0)]
        if since is not None and (not flag or i + 1 == len(flags)):
            out.append((since, time[i if flag else i - 1] - since))
            since = None
    return out


def _samples(ax):
    """Pixels along all curves and points of a panel, at most 4 apart."""
    out = []
    for line in ax.lines:
        xy = line.get_transform().transform(np.column_stack([line.get_xdata(), line.get_ydata()]).astype(float))
        xy = xy[np.isfinite(xy).all(axis=1)]
        out.append(xy)
        if line.get_linestyle() in ("None", "") or len(xy) < 2:
            continue
        for a, b in zip(xy[:-1], xy[1:]):
            steps = int(min(np.hypot(*(b - a)) / 4, 400))
            if steps > 1:
                t = np.linspace(0, 1, steps)[:, None]
                out.append(a + t * (b - a))
    return np.concatenate(out) if out else np.zeros((0, 2))


def notes(ax, items, size=7.5, taken=None):
    """Labels beside points: items of (x, y, words, colour, must). Those that must stand go first.
    taken: boxes in pixels (left, low, right, top) that stay free, as of rings."""
    fig = ax.figure
    renderer = fig.canvas.get_renderer()
    frame, curves = ax.get_window_extent(renderer), _samples(ax)
    taken = [] if taken is None else taken
    for x, y, words, hue, must in sorted(items, key=lambda item: not item[4]):
        px, py = ax.transData.transform((x, y))
        text = ax.text(0, 0, words, size=size, color=hue, transform=None, zorder=20,
                       weight="bold" if must else "normal")
        box = text.get_window_extent(renderer)
        wide, high = box.width, box.height
        best, least = None, np.inf
        for far in (5, 12, 22, 36, 54):
            for dx, dy in ((1, 1), (1, -1), (-1, 1), (-1, -1), (1, 0), (-1, 0), (0, 1), (0, -1)):
                left = px + dx * far + (-wide if dx < 0 else -0.5 * wide if dx == 0 else 0)
                low = py + dy * far + (-high if dy < 0 else -0.5 * high if dy == 0 else 0)
                right, top = left + wide, low + high
                if left < frame.x0 or right > frame.x1 or low < frame.y0 or top > frame.y1:
                    continue
                if any(left < t[2] + 2 and t[0] - 2 < right and low < t[3] + 1 and t[1] - 1 < top for t in taken):
                    continue
                ends = np.array([[px, py], [np.clip(px, left, right), np.clip(py, low, top)]])
                leader = ends[0] + np.linspace(0, 1, 12)[:, None] * (ends[1] - ends[0])
                if any(((leader > t[:2]) & (leader < t[2:])).all(axis=1).any() for t in taken
                       if not (t[0] < px < t[2] and t[1] < py < t[3])):
                    continue
                hidden = np.count_nonzero((curves[:, 0] > left - 2) & (curves[:, 0] < right + 2) &
                                          (curves[:, 1] > low - 1) & (curves[:, 1] < top + 1))
                cost = hidden + 0.05 * far
                if cost < least:
                    best, least = (left, low, right, top, far), cost
            if least < 1.5:
                break
        if best is None or (not must and least > 6):
            text.remove()
            continue
        left, low, right, top, far = best
        text.set_position((left, low))
        text.set_va("bottom")
        taken.append((left, low, right, top))
        if far > 12:
            to = (np.clip(px, left, right), np.clip(py, low, top))
            ax.plot(*zip(ax.transData.inverted().transform((px, py)), ax.transData.inverted().transform(to)),
                    color=hue, lw=0.7, alpha=0.8, zorder=15)
    return taken


def over_time(ax, lines, unit, words, seconds, least=1.0, size=8.5, time_label=False):
    """A small panel: lines of (x, y, name, colour)."""
    for x, y, name, hue in lines:
        ax.plot(x, y, color=hue, lw=1.1, label=name or "_")
    room(ax, [y for _, y, _, _ in lines], least)
    ax.yaxis.set_major_locator(MaxNLocator(5))
    ax.set_ylabel(unit, labelpad=2)
    time_axis(ax, seconds, time_label)
    title(ax, words, size)
    legend(ax, 7.5, handle=0.9)
