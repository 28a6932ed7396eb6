"""Plots with matplotlib. If it is missing, plots are skipped with one warning."""
import sys

try:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
except ImportError:
    pyplot = None


def warn_if_missing():
    if pyplot is None:
        print("no plots: install python3-matplotlib", file=sys.stderr)


def curves(path, x_label, y_label, lines, log=False):
    """`lines` are (label, x values, y values). Returns pictures for a Document: one, or none without matplotlib."""
    if pyplot is None or not lines:
        return []
    figure, axes = pyplot.subplots(figsize=(9, 5), layout="constrained")
    for index, (label, xs, ys) in enumerate(lines):
        axes.plot(xs, ys, label=label, marker="o" if len(xs) < 20 else None, linewidth=1.2,
                  color=f"C{index // 2 % 10}" if len(lines) > 10 else None, linestyle="-" if index % 2 == 0 else "--")
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    if log:
        axes.set_yscale("log")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5))
    figure.savefig(path, dpi=110)
    pyplot.close(figure)
    return [(path.name, f"{y_label} over {x_label}")]
