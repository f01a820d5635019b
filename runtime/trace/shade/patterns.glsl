// Solid patterns in closed form, in the words that C++ and GLSL share (compiler/support/formula_words.h):
// sums of cosines, so that POV-Ray's functions say the same (povray/emit/patterns.cpp). A file that includes
// this has pattern_wave(), which gives the waves of a level (compiler/graph/pattern.h).

/// About normal, of deviation 1. `slope`: its gradient.
FORMULA real pattern_noise(int level, real frequency, vec3 x, OUT(vec3) slope) {
    vec3 directions[8];
    real angles[8];
    real cosines[8];
    real sines[8];
    for (int i = 0; i < 8; ++i) {
        real phase;
        pattern_wave(level, i, directions[i], phase);
        angles[i] = frequency * dot(directions[i], x) + phase;
    }
    for (int i = 0; i < 8; ++i)
        cosine_and_sine(angles[i], cosines[i], sines[i]);
    real sum = REAL(0);
    slope = vec3(REAL(0));
    for (int i = 0; i < 8; ++i) {
        sum += cosines[i];
        slope -= sines[i] * directions[i];
    }
    slope *= REAL(0.5) * frequency;
    return REAL(0.5) * sum;
}

/// Distance from the nearest of four families of planes, as the sine has it.
FORMULA real pattern_cells(int level, real frequency, vec3 x, OUT(vec3) slope) {
    real nearest = REAL(2);
    slope = vec3(REAL(0));
    vec3 directions[4];
    real angles[4];
    real cosines[4];
    real sines[4];
    for (int i = 0; i < 4; ++i) {
        real phase;
        pattern_wave(level, i, directions[i], phase);
        angles[i] = REAL(0.5) * (frequency * dot(directions[i], x) + phase);
    }
    for (int i = 0; i < 4; ++i)
        cosine_and_sine(angles[i], cosines[i], sines[i]);
    for (int i = 0; i < 4; ++i) {
        if (abs(sines[i]) < nearest) {
            nearest = abs(sines[i]);
            slope = (sines[i] < REAL(0) ? REAL(-0.5) : REAL(0.5)) * frequency * cosines[i] * directions[i];
        }
    }
    // Narrow cracks between plates.
    const real crack = REAL(0.2);
    const real plate = nearest / (nearest + crack);
    slope *= REAL(3) * crack / squared(nearest + crack);
    return REAL(3) * (plate - REAL(0.55));
}

FORMULA real pattern_octave(int kind, int level, vec3 x, OUT(vec3) slope) {
    const real frequency = REAL(2) * PI * exp2(real(level));
    if (kind == 0) return pattern_noise(level, frequency, x, slope);
    if (kind == 1) {
        const real noise = pattern_noise(level, frequency, x, slope);
        slope *= noise < REAL(0) ? REAL(1.6) : REAL(-1.6);
        return REAL(1.6) * (REAL(0.8) - abs(noise));
    }
    if (kind == 2) return pattern_cells(level, frequency, x, slope);
    const real root2 = REAL(1.4142135623730951);
    real cosine;
    real sine;
    if (kind == 3) {
        cosine_and_sine(frequency * x.y, cosine, sine);
        slope = vec3(REAL(0), -root2 * frequency * sine, REAL(0));
        return root2 * cosine;
    }
    const real radius = sqrt(x.x * x.x + x.z * x.z) + REAL(1e-12);
    cosine_and_sine(frequency * radius, cosine, sine);
    slope = -root2 * frequency * sine / radius * vec3(x.x, REAL(0), x.z);
    return root2 * cosine;
}

/// The share of its waves' length that an octave's finest detail has: the cracks of cells are narrow.
FORMULA real pattern_finest(int kind) {
    return kind == 2 ? REAL(0.35) : REAL(1);
}

/// The mean of an octave.
FORMULA real pattern_mean(int kind) {
    return kind == 2 ? REAL(-0.127) : REAL(0);
}

/// The mean square of an octave's slope, where the frequency is 1.
FORMULA real pattern_steepness(int kind) {
    return kind == 1 ? REAL(2.56) : kind == 2 ? REAL(8) : REAL(1);
}

/// The level before the longest wave: of it, so much is left, and of the next one the rest.
FORMULA real pattern_first_level(real wavelength, OUT(int) level) {
    const real exact = -log2(wavelength);
    const real whole = floor(exact);
    level = int(whole);
    return REAL(1) - (exact - whole);
}

/// Moves a place by waves of twice that length. `turned_x`, `_y` and `_z`: the gradients of the moved
/// place's coordinates.
FORMULA vec3 pattern_warped(real warp, real wavelength, vec3 x, OUT(vec3) turned_x, OUT(vec3) turned_y,
                            OUT(vec3) turned_z) {
    turned_x = vec3(REAL(1), REAL(0), REAL(0));
    turned_y = vec3(REAL(0), REAL(1), REAL(0));
    turned_z = vec3(REAL(0), REAL(0), REAL(1));
    if (warp == REAL(0)) return x;
    int first = 0;
    const real left = pattern_first_level(REAL(2) * wavelength, first);
    vec3 moved = x;
    for (int i = 0; i < 2; ++i) {
        const real frequency = REAL(2) * PI * exp2(real(first + i));
        const real reach = REAL(0.4) * warp * wavelength * (i == 0 ? left : REAL(1) - left);
        vec3 directions[9];
        real angles[9];
        real cosines[9];
        real sines[9];
        for (int k = 0; k < 9; ++k) {
            real phase;
            pattern_wave(first + i, 8 + k, directions[k], phase);
            angles[k] = frequency * dot(directions[k], x) + phase;
        }
        for (int k = 0; k < 9; ++k)
            cosine_and_sine(angles[k], cosines[k], sines[k]);
        for (int k = 0; k < 9; ++k) {
            const real move = reach * cosines[k];
            const vec3 slope = -reach * frequency * sines[k] * directions[k];
            if (k < 3) {
                moved.x += move;
                turned_x += slope;
            } else if (k < 6) {
                moved.y += move;
                turned_y += slope;
            } else {
                moved.z += move;
                turned_z += slope;
            }
        }
    }
    return moved;
}

/// The value of a layer, in (0, 1), at a place. Octaves finer than `footprint`,
/// the length that a sample stands for there, fade out. `slope`: its gradient. `faded`: the mean square of
/// the slope that has faded, along one axis.
FORMULA real pattern_layer(int kind, int octaves, real warp, real wavelength, real footprint, vec3 stretch,
                           vec3 place, OUT(vec3) slope, OUT(real) faded) {
    vec3 turned_x;
    vec3 turned_y;
    vec3 turned_z;
    const vec3 x = pattern_warped(warp, wavelength, place / stretch, turned_x, turned_y, turned_z);
    int first = 0;
    const real left = pattern_first_level(wavelength, first);
    real sum = REAL(0);
    real power = REAL(0);
    faded = REAL(0);
    vec3 steep = vec3(REAL(0));
    for (int i = 0; i <= octaves; ++i) {
        // Octaves come and go gradually, so that parts of about one size look alike.
        const real depth = real(i) - (REAL(1) - left);
        real weight = depth < REAL(0) ? left : exp2(-depth);
        if (i == octaves) weight *= REAL(1) - left;
        power += weight * weight;
        const real frequency = REAL(2) * PI * exp2(real(first + i));
        const real fine = pattern_finest(kind) * exp2(real(-first - i));
        const real whole = weight;
        weight *= clamp(fine / max(footprint, fine * REAL(1e-3)) - REAL(1), REAL(0), REAL(1));
        sum += (whole - weight) * pattern_mean(kind);
        faded += (whole * whole - weight * weight) * squared(frequency) * pattern_steepness(kind);
        if (!(weight > REAL(0))) continue;
        vec3 here;
        sum += weight * pattern_octave(kind, first + i, x, here);
        steep += weight * here;
    }
    const real scale = inversesqrt(power);
    sum *= scale;
    steep *= scale;
    // A slope keeps its axes, and what warps it adds some along all; the last line flattens it to this mean square.
    const vec3 squeezed = vec3(REAL(1)) / (stretch * stretch);
    const real even = (squeezed.x + squeezed.y + squeezed.z) / REAL(3);
    const real own = kind == 3 ? squeezed.y : kind == 4 ? REAL(0.5) * (squeezed.x + squeezed.z) : even;
    const real turned = (dot(turned_x, turned_x) + dot(turned_y, turned_y) + dot(turned_z, turned_z)) / REAL(3);
    const real flattened = REAL(0.104);
    faded *= scale * scale * flattened * (own + (turned - REAL(1)) * even) / REAL(3);
    slope = (steep.x * turned_x + steep.y * turned_y + steep.z * turned_z) / stretch;
    const real root = inversesqrt(REAL(1) + sum * sum);
    slope *= REAL(0.5) * root * root * root;
    return REAL(0.5) + REAL(0.5) * sum * root;
}

/// The unit normal of a surface with this relief, a gradient, as POV-Ray has it (normal.cpp, Perturb_Normal).
/// `normal`: of unit length, to the side from where a ray of this unit direction comes; the result is, too.
FORMULA vec3 pattern_normal(vec3 normal, vec3 relief, vec3 ray_direction) {
    const real least = REAL(0.02); // of what is seen
    vec3 tilted = normalize(normal - relief);
    const real seen = -dot(tilted, ray_direction);
    if (seen < least) tilted = normalize(tilted + (seen - least) * ray_direction);
    return abs(tilted.x) <= REAL(2) ? tilted : normal; // also where it is not a number
}
