// Formulas of the sky and the air, in the words that C++ and GLSL share (compiler/support/formula_words.h).

/// Perez's formula without the factor of the zenith. `c`: its five coefficients.
FORMULA real perez_at(real c0, real c1, real c2, real c3, real c4, real cos_zenith, real cos_sun) {
    const real to_sun = acos(clamp(cos_sun, REAL(-1), REAL(1)));
    return (REAL(1) + c0 * exp(c1 / cos_zenith)) *
           (REAL(1) + c2 * exp(c3 * to_sun) + c4 * cos_sun * cos_sun);
}

/// CIE XYZ in linear sRGB (IEC 61966-2-1).
FORMULA vec3 linear_srgb_of(vec3 xyz) {
    return vec3(REAL(3.2404542) * xyz.x - REAL(1.5371385) * xyz.y - REAL(0.4985314) * xyz.z,
                REAL(-0.9692660) * xyz.x + REAL(1.8760108) * xyz.y + REAL(0.0415560) * xyz.z,
                REAL(0.0556434) * xyz.x - REAL(0.2040259) * xyz.y + REAL(1.0572252) * xyz.z);
}

/// The light of luminance and chromaticities (Y, x, y), within the gamut.
FORMULA vec3 light_of_yxy(vec3 yxy) {
    const real luminance = max(yxy.x, REAL(0));
    const vec3 xyz = luminance / yxy.z * vec3(yxy.y, yxy.z, REAL(1) - yxy.y - yxy.z);
    return max(linear_srgb_of(xyz), vec3(REAL(0)));
}

/// Henyey and Greenstein's phase function over its mean. `cos_on`: cosine of the angle that light turns by.
FORMULA real forward_scattering(real cos_on) {
    const real g = REAL(0.6); // thin mist: 10 straight on, 0.4 to the side, 0.16 back
    const real away = REAL(1) + g * g - REAL(2) * g * cos_on;
    return (REAL(1) - g * g) / (away * sqrt(away));
}

/// The integral of the haze's density from its base to s heights above it.
FORMULA real haze_column(real s) {
    return s > REAL(0) ? atan(s) : s;
}

/// A ray's way through haze.
struct HazeWay {
    real begin;    // its height above the base, in heights of the haze; 0 where that is even
    real rise;     // of a length
    real height;   // Haze's, as the distance
    real distance;
};

/// The share of what lies behind that is seen through haze (Haze::left_after()).
FORMULA real left_after_haze(HazeWay way, real length) {
    const real begin = way.begin, end = begin + length * way.rise / way.height;
    real density = REAL(1);
    if (begin > REAL(0) || end > REAL(0)) {
        const real level = REAL(1e-4); // POV-Ray's: below, the quotient is lost in rounding
        if (abs(end - begin) > level)
            density = (haze_column(end) - haze_column(begin)) / (end - begin);
        else if (begin > REAL(0))
            density = REAL(1) / (REAL(1) + begin * begin);
    }
    return exp(-length * density / way.distance);
}

/// The length of which the haze's light makes up this share of that of all `length` (Haze::length_of_share()).
FORMULA real length_of_haze_share(HazeWay way, real length, real share) {
    const real wanted = share * (REAL(1) - left_after_haze(way, length));
    real near = REAL(0), far = length;
    for (int halving = 0; halving < 50; ++halving) {
        const real middle = REAL(0.5) * (near + far);
        if (!(middle > near && middle < far)) break;
        if (REAL(1) - left_after_haze(way, middle) < wanted)
            near = middle;
        else
            far = middle;
    }
    return far;
}
