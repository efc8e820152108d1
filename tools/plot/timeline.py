"""The timeline of a dive's frames: intervals and resolution over the run, the last frames' phases."""
import style

HOST = {"wait": style.FAINT, "simulate, declare": style.SKY, "record": style.ORANGE, "submit": style.GREEN,
        "show": style.PINK}
WORDS = 0.04  # of the width: a shorter bar has no name


def run_panel(axes, data):
    style.title(axes, "frame by frame")
    time_s = data["time_s"]
    axes.plot(time_s, data["interval_ms"], ".", ms=3, color=style.GREY, label="from frame to frame")
    axes.plot(time_s, data["host_ms"], color=style.ORANGE, lw=1, label="host, from the wait's end")
    axes.plot(time_s, data["device_ms"], color=style.BLUE, lw=1, label="device, all passes")
    if data["budget_ms"] > 0:
        axes.axhline(data["budget_ms"], color=style.RED, lw=1, ls="--", label=f"budget {data['budget_ms']:.3g} ms")
    axes.set_yscale("log")
    style.plain_log(axes.yaxis)
    axes.set_ylabel("ms")
    style.legend(axes)


def scale_panel(axes, data):
    style.title(axes, "resolution of the view")
    axes.step(data["time_s"], [100 * v for v in data["view_scale"]], where="post", color=style.BLUE)
    axes.set_ylim(0, 105)
    axes.set_ylabel("resolution, %")
    axes.set_xlabel("time of the run, s")


def bar(axes, lane, start, length, colour, name, width):
    axes.barh(lane, length, left=start, height=0.7, color=colour, edgecolor="white", lw=0.5)
    if length > WORDS * width:
        axes.text(start + length / 2, lane, name, ha="center", va="center", fontsize=7, clip_on=True)


def frames_panel(axes, data):
    style.title(axes, "the last frames")
    frames = data["frames"]
    ends = [start + length for frame in frames for _, start, length in frame["host"]]
    ends += [frame["device_from_ms"] + sum(ms for _, ms in frame["passes"]) for frame in frames]
    width = max(ends, default=1)
    for frame in frames:
        for name, start, length in frame["host"]:
            bar(axes, 1, start, length, HOST[name], name, width)
        at = frame["device_from_ms"]
        for i, (name, ms) in enumerate(frame["passes"]):
            bar(axes, 0, at, ms, (style.SKY, "#8fcdf0")[i % 2], name, width)
            at += ms
        if "display_ms" in frame:
            axes.axvline(frame["display_ms"], color=style.RED, lw=1)
    for name, colour in HOST.items():
        axes.barh(1, 0, color=colour, label=name)
    axes.set_yticks([0, 1], ["device", "host"])
    axes.set_xlim(0, width)
    axes.set_xlabel("ms; device passes are drawn one after another from their submission")
    style.legend(axes)


def draw(data):
    fig = style.figure(1100, 860)
    style.heading(fig, data["title"])
    run_panel(style.area(fig, 70, 80, 1075, 330), data)
    scale_panel(style.area(fig, 70, 385, 1075, 535), data)
    frames_panel(style.area(fig, 70, 620, 1075, 800), data)
    return fig
