# Charts with logarithmic heights, as SVG. Lines of fields parted by tabs:
#   chart NAME TITLE X_LABEL X_LOW X_HIGH X_STEP lin|log Y_LOW Y_HIGH UNIT   log: x and its bounds are powers of ten,
#                                                             as the bounds of y always are; charts go row by row
#   point CHART SERIES solid|dashed|end X Y                   end: a cross where a series breaks off
#   note TEXT                                                 below the charts
# Points outside of a chart's width are left out, heights below it are put on its floor. Set -v columns=N for the
# charts in a row.
function lg(v) { return log(v) / log(10) }
function at_x(c, x) {
    return left[c] + ((x_log[c] ? lg(x) : x) - x_low[c]) / (x_high[c] - x_low[c]) * width
}
function at_y(c, y,    e) {
    e = lg(y)
    if (e < y_low[c]) e = y_low[c]
    return top[c] + height - (e - y_low[c]) / (y_high[c] - y_low[c]) * height
}
function escaped(s) { gsub(/&/, "\\&amp;", s); gsub(/</, "\\&lt;", s); return s }
function axes(c,    e, s, label) {
    printf "<text x=\"%d\" y=\"%d\" font-weight=\"bold\">%s</text>\n", left[c], top[c] - 14, escaped(title[c])
    for (e = y_low[c]; e <= y_high[c]; ++e) {
        printf "<path d=\"M%d %.1fh%d\" stroke=\"#ddd\"/>", left[c], at_y(c, 10 ^ e), width
        printf "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g %s</text>\n", left[c] - 6, at_y(c, 10 ^ e) + 4,
               10 ^ e, unit[c]
    }
    for (s = x_low[c] - x_low[c] % x_step[c]; s <= x_high[c]; s += x_step[c]) {
        if (s < x_low[c]) continue
        label = x_log[c] ? "10<tspan dy=\"-5\" font-size=\"9\">" s "</tspan>" : s
        printf "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%s</text>\n", at_x(c, x_log[c] ? 10 ^ s : s),
               top[c] + height + 18, label
    }
    printf "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%s</text>\n", left[c] + width / 2, top[c] + height + 36,
           x_label[c]
}
function polyline(c, s, kind, dashes) {
    if ((c, s, kind) in line)
        printf "<polyline points=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\"%s/>\n", line[c, s, kind],
               colour[s], dashes
}
BEGIN {
    FS = "\t"
    split("#1f77b4 #d62728 #2ca02c #9467bd #ff7f0e #8c564b #17becf #7f7f7f #bcbd22", palette, " ")
    if (!columns) columns = 2
    width = 360; height = 320
}
$1 == "chart" {
    c = $2
    charts[++chart_count] = c
    title[c] = $3; x_label[c] = $4; x_low[c] = $5; x_high[c] = $6; x_step[c] = $7; x_log[c] = $8 == "log"
    y_low[c] = $9; y_high[c] = $10; unit[c] = $11
    left[c] = 80 + (chart_count - 1) % columns * (width + 100)
    top[c] = 40 + int((chart_count - 1) / columns) * (height + 90)
}
$1 == "point" {
    if (!($3 in colour)) { order[++known] = $3; colour[$3] = palette[known] }
    if ((x_log[$2] ? lg($5) : $5) > x_high[$2] || (x_log[$2] ? lg($5) : $5) < x_low[$2]) next
    place = sprintf("%.1f,%.1f ", at_x($2, $5), at_y($2, $6))
    if ($4 == "end") {
        split(place, xy, ",")
        crosses[$2, $3] = crosses[$2, $3] sprintf("M%.1f %.1fl10 10m0 -10l-10 10", xy[1] - 5, xy[2] - 5)
    } else
        line[$2, $3, $4] = line[$2, $3, $4] place
}
$1 == "note" { notes[++note_count] = $2 }
END {
    rows = int((chart_count + columns - 1) / columns)
    below = 40 + rows * (height + 90) - 10
    total = columns * (width + 100)
    per_row = int((total - 70) / 160)
    legend_rows = int((known + per_row - 1) / per_row)
    printf "<svg xmlns=\"http://www.w3.org/2000/svg\" font-family=\"sans-serif\" font-size=\"12\""
    printf " width=\"%d\" height=\"%d\">\n", total, below + 24 * (legend_rows + note_count) + 6
    print "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>"
    for (i = 1; i <= chart_count; ++i) {
        c = charts[i]
        axes(c)
        for (k = 1; k <= known; ++k) {
            s = order[k]
            polyline(c, s, "solid", "")
            polyline(c, s, "dashed", " stroke-dasharray=\"5 4\"")
            if ((c, s) in crosses)
                printf "<path d=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"2.5\"/>\n", crosses[c, s], colour[s]
        }
    }
    for (k = 1; k <= known; ++k) {
        x = 70 + (k - 1) % per_row * 160
        y = below + int((k - 1) / per_row) * 24
        printf "<path d=\"M%d %dh24\" stroke=\"%s\" stroke-width=\"3\"/><text x=\"%d\" y=\"%d\">%s</text>\n", x, y,
               colour[order[k]], x + 30, y + 4, escaped(order[k])
    }
    for (k = 1; k <= note_count; ++k)
        printf "<text x=\"70\" y=\"%d\">%s</text>\n", below + (legend_rows + k - 1) * 24 + 8, escaped(notes[k])
    print "</svg>"
}
