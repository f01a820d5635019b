// Random numbers of a sample: SampleStream of runtime/trace, whose numbers of 64 bits are pairs here, the low
// half first.

uvec2 product64(uvec2 a, uvec2 b) {
    uint high, low;
    umulExtended(a.x, b.x, high, low);
    return uvec2(low, high + a.x * b.y + a.y * b.x);
}

uvec2 sum64(uvec2 a, uvec2 b) {
    const uint low = a.x + b.x;
    return uvec2(low, a.y + b.y + (low < a.x ? 1u : 0u));
}

/// x ^ (x >> bits), with less than 32.
uvec2 folded64(uvec2 x, uint bits) {
    return uvec2(x.x ^ ((x.x >> bits) | (x.y << (32u - bits))), x.y ^ (x.y >> bits));
}

/// CounterRandom::mixed().
uvec2 mixed64(uvec2 x) {
    const uvec2 once = product64(folded64(x, 30u), uvec2(0x1CE4E5B9u, 0xBF58476Du));
    const uvec2 twice = product64(folded64(once, 27u), uvec2(0x133111EBu, 0x94D049BBu));
    return folded64(twice, 31u);
}

uvec2 golden64(uint times) {
    return product64(uvec2(0x7F4A7C15u, 0x9E3779B9u), uvec2(times, 0u));
}

struct Stream {
    uvec2 key;
    uint index; // of the sample
    uint pair;
};

Stream stream_of(uvec2 seed, uint index) {
    Stream stream;
    stream.key = mixed64(seed);
    stream.index = index;
    stream.pair = 0u;
    return stream;
}

/// In [0, 1).
float unit_of(uint bits) {
    return float(bits >> 8) * (1.0f / 16777216.0f);
}

vec2 next_place(INOUT(Stream) stream) {
    const uvec2 key = mixed64(mixed64(sum64(stream.key, golden64(stream.pair))));
    ++stream.pair;
    const uvec2 first = mixed64(key), second = mixed64(sum64(key, golden64(1u)));
    const uint index = scrambled_bits(stream.index, first.x);
    return vec2(unit_of(scrambled_first(index, first.y)),
                unit_of(scrambled_second(index, second.x)));
}
