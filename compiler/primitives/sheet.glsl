// The formula of sheets, in the words that C++ and GLSL share (compiler/support/formula_words.h).

/// The thickness of a solid that a map flattens to a sheet, along the sheet's unit normal; below 0 where it is none.
/// `x`, `y`, `z`: the map's columns. `extents`: of the solid along its axes. `wide`: it is drawn wider than it is.
FORMULA real sheet_thickness(vec3 x, vec3 y, vec3 z, vec3 extents, bool wide, OUT(vec3) normal) {
    // Shares of the half axis of a round face of the same area, and of the shorter half axis of the faces: thicker ones
    // are rods. A turtle's disc has a 25th of the first, however it is stretched within its plane.
    const real most_of_mean = wide ? REAL(0.5) : REAL(0.05), most_of_shorter = REAL(0.5);
    const vec3 rows = max(max(abs(x), abs(y)), abs(z));
    const real largest = max(max(rows.x, rows.y), rows.z);
    normal = vec3(REAL(0));
    if (!(largest > REAL(0))) return REAL(-1);
    const vec3 a = x / largest, b = y / largest, c = z / largest; // squares of their lengths are numbers
    // Cofactors of a flat map are the product of its two larger stretches, along the third's direction. They are
    // normal to two columns: the third alone leads from face to face.
    vec3 across = cross(a, b);
    const real volume = abs(dot(across, c));
    real extent = extents.z;
    const vec3 across_x = cross(b, c), across_y = cross(c, a);
    if (length(across_x) > length(across)) {
        across = across_x;
        extent = extents.x;
    }
    if (length(across_y) > length(across)) {
        across = across_y;
        extent = extents.y;
    }
    const real area = length(across);
    if (!(area > REAL(0))) return REAL(-1);
    const real shorter = area / max(length(a), max(length(b), length(c)));
    const real thickness = extent * volume / area;
    if (!(thickness <= most_of_mean * sqrt(area) && thickness <= most_of_shorter * shorter)) return REAL(-1);
    normal = across / area;
    return largest * thickness;
}
