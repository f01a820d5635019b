// Solid patterns in closed form, in the words that C++ and GLSL share (compiler/support/formula_words.h):
// sums of cosines, so that POV-Ray's functions say the same (povray/emit/patterns.cpp). A file that includes
// this has pattern_wave(), which gives the waves of a level (compiler/graph/pattern.h).

/// About normal, of deviation 1. `slope`: its gradient.
FORMULA real pattern_noise(int level, real frequency, vec3 x, OUT(vec3) slope) {
    real sum = REAL(0);
    slope = vec3(REAL(0));
    for (int i = 0; i < 8; ++i) {
        vec3 direction;
        real phase;
        pattern_wave(level, i, direction, phase);
        const real angle = frequency * dot(direction, x) + phase;
        sum += cos(angle);
        slope -= frequency * sin(angle) * direction;
    }
    slope *= REAL(0.5);
    return REAL(0.5) * sum;
}

/// Distance from the nearest of four families of planes, as the sine has it.
FORMULA real pattern_cells(int level, real frequency, vec3 x, OUT(vec3) slope) {
    real nearest = REAL(2);
    slope = vec3(REAL(0));
    for (int i = 0; i < 4; ++i) {
        vec3 direction;
        real phase;
        pattern_wave(level, i, direction, phase);
        const real angle = REAL(0.5) * (frequency * dot(direction, x) + phase);
        const real wave = sin(angle);
        if (abs(wave) < nearest) {
            nearest = abs(wave);
            slope = (wave < REAL(0) ? REAL(-0.5) : REAL(0.5)) * frequency * cos(angle) * direction;
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
    if (kind == 3) {
        slope = vec3(REAL(0), -root2 * frequency * sin(frequency * x.y), REAL(0));
        return root2 * cos(frequency * x.y);
    }
    const real radius = sqrt(x.x * x.x + x.z * x.z) + REAL(1e-12);
    slope = -root2 * frequency * sin(frequency * radius) / radius * vec3(x.x, REAL(0), x.z);
    return root2 * cos(frequency * radius);
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
        for (int k = 0; k < 9; ++k) {
            vec3 direction;
            real phase;
            pattern_wave(first + i, 8 + k, direction, phase);
            const real angle = frequency * dot(direction, x) + phase;
            const real move = reach * cos(angle);
            const vec3 slope = -reach * frequency * sin(angle) * direction;
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

/// The value of a layer, in (0, 1), at a place whose stretch is taken back. Octaves finer than `footprint`,
/// the length that a sample stands for there, fade out. `slope`: its gradient.
FORMULA real pattern_layer(int kind, int octaves, real warp, real wavelength, real footprint, vec3 place,
                           OUT(vec3) slope) {
    vec3 turned_x;
    vec3 turned_y;
    vec3 turned_z;
    const vec3 x = pattern_warped(warp, wavelength, place, turned_x, turned_y, turned_z);
    int first = 0;
    const real left = pattern_first_level(wavelength, first);
    real sum = REAL(0);
    real power = REAL(0);
    vec3 steep = vec3(REAL(0));
    for (int i = 0; i <= octaves; ++i) {
        // Octaves come and go gradually, so that parts of about one size look alike.
        const real depth = real(i) - (REAL(1) - left);
        real weight = depth < REAL(0) ? left : exp2(-depth);
        if (i == octaves) weight *= REAL(1) - left;
        power += weight * weight;
        const real length = exp2(real(-first - i));
        weight *= clamp(length / max(footprint, length * REAL(1e-3)) - REAL(1), REAL(0), REAL(1));
        if (!(weight > REAL(0))) continue;
        vec3 here;
        sum += weight * pattern_octave(kind, first + i, x, here);
        steep += weight * here;
    }
    const real scale = inversesqrt(power);
    sum *= scale;
    steep *= scale;
    slope = steep.x * turned_x + steep.y * turned_y + steep.z * turned_z;
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
