#include "tests/image/random_model.h"

#include <array>
#include <random>

#include <fmt/format.h>

namespace graftal {

namespace {

class ModelText {
  public:
    explicit ModelText(std::uint64_t seed) : random_(seed) {}

    std::string rifs() {
        const int count = 3 + below(3);
        text_ = scene() + "rifs random {\n";
        for (int i = 0; i < count; ++i) {
            text_ += fmt::format("  map w{} {{\n", i);
            place(0.5, 0.7, 0.7);
            tint(0.7);
            if (one_in(3)) text_ += fmt::format("    material m{}\n", below(2));
            text_ += "  }\n";
        }
        // A way round through all maps, so that none is empty, and two thirds of the other edges.
        for (int i = 0; i < count; ++i) {
            text_ += fmt::format("  follow w{} -> w{}\n", i, (i + 1) % count);
            for (int j = 0; j < count; ++j)
                if (j != (i + 1) % count && !one_in(3)) text_ += fmt::format("  follow w{} -> w{}\n", i, j);
        }
        if (one_in(2)) text_ += fmt::format("  start w{}, w0\n", 1 + below(count - 1));
        if (one_in(2)) {
            text_ += fmt::format("  condense {}\n", solid());
            place(0.15, 0.25, 0.3);
            tint(0.5);
        }
        text_ += fmt::format("  terminal {}\n", solid());
        if (one_in(2)) text_ += fmt::format("    below {}\n", 1 + below(40));
        place(0.5, 0.9, 0.2);
        return text_ + "}\n";
    }

    /// Levels by a parameter, two objects that recur through each other, and both together.
    std::string inst() {
        text_ = scene() + "canonical object part {\n";
        instances({solid(), "triangle"}, 0.4, 0.7, 0.5);
        text_ += "}\ncanonical object level(0) {\n    part\n}\ncanonical object level(n) {\n";
        instances({"level(n - 1)", "level(n - 1)", "part"}, 0.4, 0.6, 0.7);
        text_ += "}\ncanonical object left {\n";
        instances({"left", "right", "part"}, 0.45, 0.65, 0.7);
        terminal();
        text_ += "}\ncanonical object right {\n";
        instances({"left", "right"}, 0.45, 0.65, 0.7);
        terminal();
        text_ += fmt::format("}}\nobject random {{\n");
        instances({"left", "level(4)"}, 0.8, 1, 0.6);
        return text_ + "}\n";
    }

    std::string lsys() {
        const auto turns = [&] {
            std::string text;
            for (const char* const turn : {"+", "&", "/"})
                text += fmt::format("{}({:.2f})", turn, between(-70, 70));
            return text;
        };
        text_ = scene() + fmt::format("lsys random {{\n  steps {}\n  axiom A(1)\n", 3 + below(4));
        for (const char* const from : {"A", "B"}) {
            text_ +=
                fmt::format("  {}(l) -> !({:.3f}*l)F({:.3f}*l)", from, between(0.05, 0.2), between(0.3, 0.6));
            for (int i = 0; i < 2 + below(2); ++i)
                text_ += fmt::format("[{}{}({:.3f}*l)]", turns(), one_in(2) ? "A" : "B", between(0.4, 0.75));
            text_ += fmt::format("{}F({:.3f}*l){}({:.3f}*l)\n", turns(), between(0.2, 0.4),
                                 one_in(2) ? "A" : "B", between(0.5, 0.8));
        }
        return text_ + "}\n";
    }

  private:
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
    }
    int below(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
    bool one_in(int count) { return below(count) == 0; }
    const char* solid() { return one_in(3) ? "triangle" : "cube"; }

    std::string scene() {
        std::string text = "background: 0, 0, 0\n";
        for (int i = 0; i < 2; ++i)
            text += fmt::format("material m{} {{ color: {:.3f}, {:.3f}, {:.3f} }}\n", i, between(0.1, 1),
                                between(0.1, 1), between(0.1, 1));
        return text;
    }

    void place(double least_scale, double most_scale, double reach) {
        const auto scale = [&] { return between(least_scale, most_scale); };
        if (one_in(2))
            text_ += fmt::format("    scale {:.4f}\n", scale());
        else
            text_ += fmt::format("    scale {:.4f}, {:.4f}, {:.4f}\n", scale() * (one_in(3) ? -1 : 1),
                                 scale(), scale());
        if (one_in(3)) text_ += fmt::format("    shear xy {:.4f}\n", between(-0.3, 0.3));
        text_ += fmt::format("    rotate <{:.3f}, {:.3f}, {:.3f}> {:.3f}\n", between(0.1, 1), between(-1, 1),
                             between(-1, 1), between(-180, 180));
        text_ += fmt::format("    translate {:.4f}, {:.4f}, {:.4f}\n", between(-reach, reach),
                             between(-reach, reach), between(-reach, reach));
    }

    void tint(double likelihood) {
        if (between(0, 1) > likelihood) return;
        const double alpha = one_in(6) ? below(2) : between(0.05, 0.95);
        text_ += fmt::format("    tint {:.4f}, {:.4f}, {:.4f}, {:.4f}\n", between(0, 1), between(0, 1),
                             between(0, 1), alpha);
    }

    void instances(std::initializer_list<std::string> masters, double least_scale, double most_scale,
                   double reach) {
        for (const std::string& master : masters) {
            text_ += fmt::format("    instance {}\n", master);
            place(least_scale, most_scale, reach);
            tint(0.7);
            if (one_in(4)) text_ += fmt::format("    material m{}\n", below(2));
        }
    }

    void terminal() {
        text_ += "    terminal part\n";
        if (one_in(2)) text_ += fmt::format("        below {}\n", 1 + below(40));
        place(0.5, 0.8, 0.2);
        tint(0.5);
    }

    std::mt19937_64 random_;
    std::string text_;
};

} // namespace

std::string random_rifs(std::uint64_t seed) {
    return ModelText(seed).rifs();
}

std::string random_inst(std::uint64_t seed) {
    return ModelText(seed).inst();
}

std::string random_lsys(std::uint64_t seed) {
    return ModelText(seed).lsys();
}

} // namespace graftal
