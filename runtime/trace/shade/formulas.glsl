// Formulas of light on surfaces, in the words that C++ and GLSL share (compiler/support/formula_words.h). The
// native engine has them in doubles, the kernel of GPUs in floats.

FORMULA real squared(real x) {
    return x * x;
}

/// Fresnel's reflectance for unpolarized light, as POV-Ray has it. `ior`: of what is behind the surface over
/// that of what the light is in; `cosine`: to the normal, in [0, 1]. 1 where all is reflected.
FORMULA real fresnel(real ior, real cosine) {
    const real square = ior * ior + cosine * cosine - REAL(1);
    if (!(square > REAL(0))) return REAL(1);
    const real g = sqrt(square);
    const real across = REAL(0.5) * squared((g - cosine) / (g + cosine));
    const real ratio = (cosine * (g + cosine) - REAL(1)) / (cosine * (g - cosine) + REAL(1));
    return clamp(across * (REAL(1) + ratio * ratio), REAL(0), REAL(1));
}

/// White light after a surface of this colour, as metallic as that: at grazing angles it stays white.
/// POV-Ray's formula, an empirical one. `cosine`: to the normal.
FORMULA vec3 metal_colour(real metallic, vec3 rgb, real cosine) {
    const real angle = acos(clamp(cosine, REAL(-1), REAL(1))) / (PI / REAL(2));
    const real white = clamp(REAL(0.014567225) / squared(angle - REAL(1.12)) - REAL(0.011612903), REAL(0), REAL(1));
    return vec3(REAL(1)) + metallic * (REAL(1) - white) * (rgb - vec3(REAL(1)));
}

/// Two unit vectors at right angles to a unit vector, and to each other.
FORMULA void axes_across_of(vec3 direction, OUT(vec3) a, OUT(vec3) b) {
    const vec3 other = abs(direction.x) < REAL(0.9) ? vec3(REAL(1), REAL(0), REAL(0)) : vec3(REAL(0), REAL(1), REAL(0));
    a = normalize(cross(direction, other));
    b = cross(direction, a);
}

/// A unit vector at that cosine and turn about a unit vector.
FORMULA vec3 from_pole(vec3 pole, real along, real turn) {
    vec3 a;
    vec3 b;
    axes_across_of(pole, a, b);
    const real radius = sqrt(max(REAL(0), REAL(1) - along * along));
    return along * pole + radius * (cos(turn) * a + sin(turn) * b);
}

/// A direction in the half about a unit normal: its density is the cosine over pi.
FORMULA vec3 cosine_direction(vec3 normal, vec2 place) {
    return from_pole(normal, sqrt(REAL(1) - place.x), REAL(2) * PI * place.y);
}

/// Its density is 1 / (2 pi).
FORMULA vec3 even_direction(vec3 normal, vec2 place) {
    return from_pole(normal, REAL(1) - place.x, REAL(2) * PI * place.y);
}

/// A surface's choice of a direction towards the sky, by the cosine: in the half that it faces, with
/// `front_chance`, or in the other if light comes through. If the surface shines, half of the choices are
/// even.
FORMULA vec3 sky_choice(real front_chance, bool shines, vec3 normal, vec2 chosen) {
    vec2 place = chosen;
    const bool behind = place.x >= front_chance;
    place.x = behind ? (place.x - front_chance) / (REAL(1) - front_chance) : place.x / front_chance;
    if (behind) return cosine_direction(-normal, place);
    const bool even = shines && place.x < REAL(0.5);
    if (shines) place.x = even ? REAL(2) * place.x : REAL(2) * place.x - REAL(1);
    return even ? even_direction(normal, place) : cosine_direction(normal, place);
}

/// The density of sky_choice(), a steradian, times pi. `along`: the cosine with the normal.
FORMULA real sky_choice_density_pi(real front_chance, bool shines, real along) {
    if (along < REAL(0)) return (REAL(1) - front_chance) * -along;
    return front_chance * (shines ? REAL(0.5) * along + REAL(0.25) : along);
}

/// The normal of a facet of a rough mirror or rough glass, whose normals are spread as Trowbridge and Reitz (1975)
/// have them (GGX; Walter et al. 2007, "Microfacet models for refraction through rough surfaces"). It is chosen by
/// how much of it the viewer sees (Heitz 2018, "Sampling the GGX distribution of visible normals"). Unit vectors;
/// the viewer is on the normal's side. `blur`: the alpha of Trowbridge and Reitz, in (0, 1]; `place`: in [0, 1)^2.
FORMULA vec3 visible_facet(vec3 normal, vec3 to_viewer, real blur, vec2 place) {
    vec3 x_axis;
    vec3 y_axis;
    axes_across_of(normal, x_axis, y_axis);
    // Squeezed along the surface, the facets form a half sphere; the viewer sees a disc of it.
    const vec3 seen = normalize(vec3(blur * dot(to_viewer, x_axis), blur * dot(to_viewer, y_axis),
                                     max(REAL(0), dot(to_viewer, normal))));
    const real across = hypotenuse(seen.x, seen.y);
    const vec3 right = across > REAL(0) ? vec3(-seen.y, seen.x, REAL(0)) / across : vec3(REAL(1), REAL(0), REAL(0));
    const vec3 up = cross(seen, right);
    const real radius = sqrt(place.x), turn = REAL(2) * PI * place.y;
    const real s = radius * cos(turn);
    const real lit = REAL(0.5) * (REAL(1) + seen.z); // the rest of the disc lies below the surface
    const real t = (REAL(1) - lit) * sqrt(max(REAL(0), REAL(1) - s * s)) + lit * radius * sin(turn);
    const vec3 facet = s * right + t * up + sqrt(max(REAL(0), REAL(1) - s * s - t * t)) * seen;
    return normalize(blur * facet.x * x_axis + blur * facet.y * y_axis + max(REAL(0), facet.z) * normal);
}

/// The share of facets that others do not hide from a direction with this cosine to the normal (Smith's G1):
/// what is left of light that a visible facet sends there. 0 below the surface.
FORMULA real unhidden(real cosine, real blur) {
    if (!(cosine > REAL(0))) return REAL(0);
    const real square = blur * blur;
    return REAL(2) * cosine / (cosine + sqrt(square + (REAL(1) - square) * cosine * cosine));
}

/// The mean cosine between a surface and its parts, where a relief too fine to be seen tilts them: `faded` is
/// the mean square of its slope along one axis. About that of a normal distribution (small: 1 - faded; large:
/// 0.53 over the slope).
FORMULA real facing_of_relief(real faded) {
    return inversesqrt(REAL(1) + faded * (REAL(2) + REAL(1.53) * faded / (REAL(1) + faded)));
}

/// The mean cosine towards a light of the parts of a surface, in place of that of the whole, which is not negative.
/// Parts that face away count as 0. `facing`: facing_of_relief(), 1 where there is no relief. It is about the mean of
/// max(0, x) in a normal distribution about facing * cosine, whose variance is a third of what `facing` leaves.
FORMULA real lit_cosine(real cosine, real facing) {
    const real middle = facing * cosine;
    const real spread = REAL(2) / (REAL(3) * PI) * (REAL(1) - facing * facing);
    return REAL(0.5) * (middle + sqrt(middle * middle + spread));
}

/// The light from all sides of such a surface over that of an even one: the mean of lit_cosine(), about.
FORMULA real lit_from_all_sides(real facing) {
    return REAL(0.5) * (facing + sqrt(facing * facing + REAL(8) / (REAL(3) * PI) * (REAL(1) - facing * facing)));
}

/// Gives the numbers of a material what a relief does that is too fine to be seen: its slopes spread highlights
/// and mirrored rays. `faded`: the mean square of the slopes along one axis; `facing`: facing_of_relief().
FORMULA void roughen_by_relief(real faded, OUT(real) facing, INOUT(real) specular, INOUT(real) roughness,
                               INOUT(real) blur) {
    facing = facing_of_relief(faded);
    // A highlight of exponent 1 / r is as wide as slopes of the mean square r; one twice as wide is half as bright.
    specular *= roughness / (roughness + faded);
    roughness += faded;
    blur = min(REAL(1), sqrt(blur * blur + REAL(2) * faded));
}

// Sample sequences: Sobol's first two dimensions, scrambled (Owen; Laine and Karras 2011).

FORMULA uint bits_reversed(uint bits) {
    uint x = bits;
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// Flips each bit by a hash of those below it: Laine and Karras (2011) with the constants of Vegdahl (2021).
FORMULA uint flipped_by_lower_bits(uint bits, uint seed) {
    uint x = bits;
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// Owen's scrambling: flips each bit by a hash of those above it.
FORMULA uint scrambled_bits(uint x, uint seed) {
    return bits_reversed(flipped_by_lower_bits(bits_reversed(x), seed));
}

/// The first dimension of Sobol's sequence, which is bits_reversed(index), scrambled by Owen's rule.
FORMULA uint scrambled_first(uint index, uint seed) {
    return bits_reversed(flipped_by_lower_bits(index, seed));
}

/// The second dimension likewise. Its bit j from the top is the parity of the bits i of the index for which the
/// binomial coefficient C(i, j) is odd; by Lucas that are those whose i has all the bits of j.
FORMULA uint scrambled_second(uint index, uint seed) {
    uint x = index;
    x ^= (x >> 1) & 0x55555555u;
    x ^= (x >> 2) & 0x33333333u;
    x ^= (x >> 4) & 0x0f0f0f0fu;
    x ^= (x >> 8) & 0x00ff00ffu;
    x ^= x >> 16;
    return bits_reversed(flipped_by_lower_bits(x, seed));
}
