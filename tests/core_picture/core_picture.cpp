// A picture by the core alone, as one number: the hash of its floats. A build for another target gives the
// same.

#include <cstdio>
#include <cstring>

#include "compiler/session/session.h"
#include "compiler/session/stages.h"
#include "compiler/support/files.h"
#include "runtime/trace/model/trace_model.h"
#include "runtime/trace/picture_tracer.h"

namespace {

using namespace graftal;

/// FNV-1a of the bits.
std::uint64_t hash_of(const Image& image) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const float sample : image.pixels) {
        unsigned char bytes[sizeof sample];
        std::memcpy(bytes, &sample, sizeof sample);
        for (const unsigned char byte : bytes)
            hash = (hash ^ byte) * 0x100000001b3;
    }
    return hash;
}

struct Model {
    const char* name;
    const char* text;
};

constexpr Model models[] = {
    {"crystal.rifs",
     "use tree = \"tree.lsys\"\nrifs crystal {\n  map n { scale 1/2  translate <0, 1/2, 0> }\n"
     "  map e { scale 1/2  translate <1/2, 0, 0> }\n  map w { scale 1/3  rotate y, 40 }\n"
     "  terminal tree\n}\nsky { bounces: 1 }\n"},
    {"tree.lsys", "lsys tree {\n  angle 25\n  steps 6\n  width 0.1\n  axiom A(1)\n"
                  "  A(s) -> F(s)[+A(s*0.8)]/(137)[-A(s*0.7)]\n}\n"},
    {"heap.inst", "object heap { scatter sphere over -3, -3, 3, 3 count 200  scale: 0.3 }\n"},
};

} // namespace

int main() {
    MemoryFiles files;
    for (const Model& model : models)
        files.set(model.name, model.text);
    for (const Model& model : models) {
        Session session(model.name, files);
        StageOptions options;
        options.view.size = {160, 90};
        Compilation compilation;
        const auto viewed = session.viewed(options, compilation);
        const auto prepared = viewed ? session.prepared(options, compilation) : nullptr;
        if (!prepared) {
            std::fputs(compilation.diagnostics.render(compilation.sources).c_str(), stderr);
            return 1;
        }
        const TraceModel traced(prepared, viewed->view, resolved(options.detail, *viewed));
        Image image{160, 90, 3, {}};
        image.pixels.resize(3 * 160 * 90);
        PictureTracer tracer(traced);
        tracer.trace({.most_samples = 2}, {}, image);
        std::printf("%s %016llx\n", model.name, static_cast<unsigned long long>(hash_of(image)));
    }
}
