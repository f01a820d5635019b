# Lines of name, steps, seconds and MiB composed, the same expanded (text where there is nothing): an SVG of two
# charts over the steps, up to the depth that expansion reaches and a little farther.
function lg(v) { return log(v) / log(10) }
function at_x(steps) { return left + (steps - 2) / (most_steps - 2) * width }
function at_y(chart, v) {
    return top + height - (lg(v) - low[chart]) / (high[chart] - low[chart]) * height
}
function line(chart, name, expanded,    i, v, points, style) {
    for (i = 1; i <= count; ++i) {
        v = value[chart, expanded, i]
        if (names[i] != name || steps[i] > most_steps || v !~ /^[0-9.]+$/) continue
        points = points sprintf("%.1f,%.1f ", at_x(steps[i]), at_y(chart, v < least[chart] ? least[chart] : v))
    }
    style = expanded ? "" : " stroke-dasharray=\"5 4\""
    printf "<polyline points=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\"%s/>\n", points, colour[name], style
}
function chart_of(chart, title, unit,    e, s, k) {
    printf "<text x=\"%d\" y=\"%d\" font-weight=\"bold\">%s</text>\n", left, top - 14, title
    for (e = low[chart]; e <= high[chart]; ++e) {
        printf "<path d=\"M%d %.1fh%d\" stroke=\"#ddd\"/>", left, at_y(chart, 10 ^ e), width
        printf "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g %s</text>\n", left - 6, at_y(chart, 10 ^ e) + 4,
               10 ^ e, unit
    }
    for (s = 5; s <= most_steps; s += 5)
        printf "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%d</text>\n", at_x(s), top + height + 18, s
    printf "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">steps</text>\n", left + width / 2, top + height + 36
    for (k = 1; k <= known; ++k) { line(chart, order[k], 0); line(chart, order[k], 1) }
}
BEGIN {
    split("#1f77b4 #d62728 #2ca02c #9467bd #ff7f0e #8c564b", palette)
    most_steps = 25; left = 70; top = 40; width = 360; height = 320
    low["time"] = -3; high["time"] = 1; least["time"] = 0.001
    low["peak"] = 0; high["peak"] = 3; least["peak"] = 1
}
{
    ++count
    names[count] = $1; steps[count] = $2
    value["time", 0, count] = $3; value["peak", 0, count] = $4
    value["time", 1, count] = $5; value["peak", 1, count] = $NF
    if (!($1 in colour)) { order[++known] = $1; colour[$1] = palette[known] }
}
END {
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"920\" height=\"500\" font-family=\"sans-serif\" font-size=\"12\">"
    print "<rect width=\"920\" height=\"500\" fill=\"white\"/>"
    chart_of("time", "time of graftal stats", "s")
    left = 530
    chart_of("peak", "peak memory", "MiB")
    for (k = 1; k <= known; ++k) {
        x = 70 + (k - 1) * 140
        printf "<path d=\"M%d 440h24\" stroke=\"%s\" stroke-width=\"3\"/><text x=\"%d\" y=\"444\">%s</text>\n", x,
               colour[order[k]], x + 30, order[k]
    }
    print "<text x=\"70\" y=\"476\">solid: expanded (--exact), as far as it goes; dashed: composed</text>"
    print "</svg>"
}
