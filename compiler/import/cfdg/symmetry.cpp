#include "compiler/import/cfdg/symmetry.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace graftal::cfdg {

namespace {

constexpr double close_by = 1e-7;
constexpr double highest_order = 1000;
constexpr const char* no_number_or_centre = "takes no number, or the two of a centre";

bool alike(const Affine& a, const Affine& b) {
    return largest_entry(a.linear - b.linear) < close_by &&
           largest_entry(a.translation - b.translation) < close_by;
}

Affine about(Vec3 centre, const Affine& map) {
    return Affine::translate(centre) * map * Affine::translate(-centre);
}

Affine turn(double degrees) {
    return Affine::rotate({0, 0, 1}, degrees);
}

/// A mirror along an axis of this direction.
Affine mirror(double degrees) {
    return turn(degrees) * Affine::scale({1, -1, 1}) * turn(-degrees);
}

/// The angles of the four mirror axes that Context Free numbers: x, y, the diagonal and the other diagonal.
constexpr double axes[] = {0, 90, 45, -45};

/// An order of 2.5 makes 2 copies, 144 degrees apart, as in Context Free.
std::vector<Affine> dihedral(double order, Vec3 centre, bool mirrors, double axis_deg) {
    std::vector<Affine> maps;
    for (int i = 0; i < static_cast<int>(order); ++i) {
        const Affine turned = turn(360.0 * i / order);
        maps.push_back(about(centre, turned));
        if (mirrors) maps.push_back(about(centre, mirror(axis_deg) * turned));
    }
    return maps;
}

/// The properties of a tile that rows of the table of groups ask for.
struct Tile {
    bool rectangular = false, square = false, rhombic = false, hexagonal = false, diagonal = false;
    double side = 0; ///< of a square on its corner
};

Tile tile_of(const Lattice& lattice) {
    Tile tile;
    if (!lattice.is_tiled()) return tile;
    const Vec3 u = lattice.across, v = lattice.up;
    const bool flat = std::abs(u.y) <= close_by, upright = std::abs(v.x) <= close_by;
    tile.rectangular = flat && upright;
    tile.square = tile.rectangular && std::abs(u.x - v.y) <= close_by;
    tile.rhombic =
        (flat && std::abs(v.x / u.x - 0.5) < close_by) || (upright && std::abs(u.y / v.y - 0.5) < close_by);
    const double a = glm::length(u), b = glm::length(v);
    tile.hexagonal = tile.rhombic && std::abs(a / b - 1) < close_by;
    tile.diagonal = tile.rhombic &&
                    (std::abs(a / b - std::sqrt(2)) < close_by || std::abs(b / a - std::sqrt(2)) < close_by);
    tile.side = std::min(a, b);
    return tile;
}

/// All products of the maps, up to the lattice.
std::vector<Affine> closed(std::vector<Affine> maps, const Lattice& lattice) {
    const auto same = [&](const Affine& a, const Affine& b) {
        if (largest_entry(a.linear - b.linear) >= close_by) return false;
        Vec3 offset = a.translation - b.translation;
        const double area = lattice.across.x * lattice.up.y - lattice.across.y * lattice.up.x;
        for (const Vec3 step : {lattice.across, lattice.up}) { // whole steps of the lattice
            if (step == Vec3(0.0)) continue;
            const Vec3 other = step == lattice.across ? lattice.up : lattice.across;
            const double share =
                area != 0 ? (offset.x * other.y - offset.y * other.x) / (step.x * other.y - step.y * other.x)
                          : glm::dot(offset, step) / glm::dot(step, step);
            offset -= std::round(share) * step;
        }
        return largest_entry(offset) < close_by * 10;
    };
    maps.insert(maps.begin(), Affine());
    std::vector<Affine> all;
    const auto add = [&](const Affine& map) {
        if (std::ranges::none_of(all, [&](const Affine& other) { return same(map, other); }))
            all.push_back(map);
    };
    for (const Affine& map : maps)
        add(map);
    for (std::size_t i = 0; i < all.size() && all.size() < 64; ++i)
        for (const Affine& map : maps)
            add(map * all[i]);
    return all;
}

} // namespace

void add_unique(std::vector<Affine>& maps, const std::vector<Affine>& more) {
    for (const Affine& map : more)
        if (std::ranges::none_of(maps, [&](const Affine& other) { return alike(map, other); }))
            maps.push_back(map);
}

std::optional<std::vector<Affine>> symmetry(std::string_view name, const std::vector<double>& n,
                                            const Lattice& lattice, std::string& fault) {
    const auto fail = [&](std::string words) {
        fault = fmt::format("'{}' {}", name, words);
        return std::nullopt;
    };
    if (name == "CF::Cyclic" || name == "CF::Dihedral") {
        const bool mirrors = name == "CF::Dihedral";
        if (n.empty() || !(n[0] >= 1 && n[0] <= highest_order) || n.size() > 4 ||
            (!mirrors && n.size() % 2 == 0))
            return fail(fmt::format("takes an order of 1 to 1000{}, and may take the two numbers of a centre",
                                    mirrors ? ", may take the angle of a mirror" : ""));
        const double axis = n.size() == 2 || n.size() == 4 ? n[1] : 0;
        const Vec3 centre = n.size() >= 3 ? Vec3(n[n.size() - 2], n[n.size() - 1], 0) : Vec3(0.0);
        return dihedral(n[0], centre, mirrors, axis);
    }
    const Tile tile = tile_of(lattice);
    const bool right = tile.rectangular || tile.diagonal;
    const auto centre = [&](std::size_t from) {
        return n.size() >= from + 2 ? Vec3(n[from], n[from + 1], 0) : Vec3(0.0);
    };
    static const std::map<std::string_view, int> frieze = {{"CF::p11g", 0}, {"CF::p11m", 1}, {"CF::p1m1", 2},
                                                           {"CF::p2mg", 3}, {"CF::p2mm", 4}, {"CF::p2", 5}};
    if (const auto row = frieze.find(name); row != frieze.end()) {
        if (!lattice.is_frieze() && !(row->second == 5 && lattice.is_tiled()))
            return fail("needs a 'CF::Tile' of one direction");
        const bool by_offset = row->second <= 2;
        if (!n.empty() && n.size() != (by_offset ? 1u : 2u))
            return fail(by_offset ? "takes no number, or the offset of its axis" : no_number_or_centre);
        const bool level = lattice.across != Vec3(0.0);
        const Vec3 half = (lattice.across + lattice.up) * 0.5;
        const double along = level ? 0 : 90;
        const double at = n.empty() ? 0 : n[0];
        const Vec3 offset = level ? Vec3(0, at, 0) : Vec3(at, 0, 0),
                   other = level ? Vec3(at, 0, 0) : Vec3(0, at, 0);
        const Affine glide = Affine::translate(half) * about(by_offset ? offset : centre(0), mirror(along));
        switch (row->second) {
        case 0:
            return closed({glide}, lattice);
        case 1:
            return closed({about(offset, mirror(along))}, lattice);
        case 2:
            return closed({about(other, mirror(along + 90))}, lattice);
        case 3: { // the centre is that of half turns; mirrors stand a quarter of the tile beside it
            std::vector<Affine> maps = dihedral(2, centre(0), false, 0);
            maps.push_back(glide);
            return closed(maps, lattice);
        }
        case 4:
            return closed(dihedral(2, centre(0), true, 0), lattice);
        default:
            return closed(dihedral(2, centre(0), false, 0), lattice);
        }
    }
    static const std::map<std::string_view, int> wallpaper = {
        {"CF::pm", 0},  {"CF::pg", 1},    {"CF::cm", 2},    {"CF::pmm", 3}, {"CF::pmg", 4},
        {"CF::pgg", 5}, {"CF::cmm", 6},   {"CF::p4", 7},    {"CF::p4m", 8}, {"CF::p4g", 9},
        {"CF::p3", 10}, {"CF::p3m1", 11}, {"CF::p31m", 12}, {"CF::p6", 13}, {"CF::p6m", 14}};
    const auto row = wallpaper.find(name);
    if (row == wallpaper.end()) return fail("is no symmetry");
    const int group = row->second;
    const bool by_axis = group <= 2 || group == 4;
    if (!lattice.is_tiled()) return fail("needs a 'CF::Tile' of two directions");
    const bool fits = group == 2 || group == 6 ? tile.rhombic || tile.square
                      : group <= 5             ? right
                      : group <= 9             ? tile.square || tile.diagonal
                                               : tile.hexagonal;
    if (!fits) return fail("does not fit this 'CF::Tile'");
    const double first_axis = (group == 2 ? tile.square : tile.diagonal) ? 2 : 0;
    // Context Free drops the fraction of an axis: 0.2 is the axis 0.
    const double number = by_axis && !n.empty() ? std::trunc(n[0]) : first_axis;
    if (by_axis && (n.empty() || !(number >= first_axis && number <= first_axis + 1)))
        return fail(
            fmt::format("takes an axis of {} or {} with this 'CF::Tile'", first_axis, first_axis + 1));
    if (by_axis && n.size() > 1 && n.size() != (group == 4 ? 3u : 2u))
        return fail(group == 4 ? "takes an axis, and may take the two numbers of a centre"
                               : "takes an axis, and may take an offset of it");
    if (!by_axis && !n.empty() && n.size() != 2) return fail(no_number_or_centre);
    const double axis = by_axis ? axes[static_cast<std::size_t>(number)] : 0;
    const auto direction = [](double degrees) { return turn(degrees).linear[0]; };
    const auto half_step = [&](double degrees) { // half of the shortest way of the lattice along an axis
        const double length = tile.diagonal             ? tile.side
                              : std::abs(degrees) == 90 ? lattice.up.y
                                                        : lattice.across.x;
        return direction(degrees) * (length / 2);
    };
    // Context Free counts the offset of an axis to the right or upwards, except of a diagonal.
    const double side = axis == 90 || (axis == 45 && group != 2) ? -1 : 1;
    const Vec3 offset = n.size() >= 2 ? direction(axis + 90) * (side * n[1]) : Vec3(0.0);
    switch (group) {
    case 0:
    case 2:
        return closed({about(offset, mirror(axis))}, lattice);
    case 1:
        return closed({Affine::translate(half_step(axis)) * about(offset, mirror(axis))}, lattice);
    case 3:
    case 6: {
        const bool turned = tile.diagonal;
        return closed(dihedral(2, centre(0), true, turned ? 45 : 0), lattice);
    }
    case 4: // a mirror along the axis, and a glide across it
        return closed({about(centre(1), mirror(axis)),
                       Affine::translate(half_step(axis + 90 > 90 ? axis - 90 : axis + 90)) *
                           about(centre(1), mirror(axis + 90))},
                      lattice);
    case 5: {
        const double first = tile.diagonal ? 45 : 0, second = tile.diagonal ? -45 : 90;
        return closed({Affine::translate(half_step(first)) * about(centre(0), mirror(first)),
                       Affine::translate(half_step(second)) * about(centre(0), mirror(second))},
                      lattice);
    }
    case 7:
    case 8:
        return closed(dihedral(4, centre(0), group == 8, tile.square ? 45 : 0), lattice);
    case 9: { // a quarter turn, and a mirror that misses its centre by a quarter of the tile
        const double along = tile.diagonal ? -45 : 90;
        const Vec3 step = half_step(along);
        const Vec3 beside =
            tile.diagonal ? direction(45) * (-tile.side / 4) : Vec3(-lattice.across.x / 4, 0, 0);
        return closed({about(centre(0), turn(90)),
                       about(centre(0), Affine::translate(step) * about(beside, mirror(along)))},
                      lattice);
    }
    case 10:
        return closed(dihedral(3, centre(0), false, 0), lattice);
    case 11:
    case 12: {
        const bool leans = std::abs(lattice.up.x) > close_by;
        const bool deg30 = !leans != (group == 11);
        return closed(dihedral(3, centre(0), true, deg30 ? 30 : 60), lattice);
    }
    default:
        return closed(dihedral(6, centre(0), group == 14, 0), lattice);
    }
}

void SymmetryReader::begin(const std::string& word) {
    end();
    word_ = word;
}

bool SymmetryReader::add(const std::vector<double>& numbers) {
    if (word_.empty()) return false;
    numbers_.insert(numbers_.end(), numbers.begin(), numbers.end());
    return true;
}

void SymmetryReader::end() {
    if (word_.empty()) return;
    std::string fault;
    if (const std::optional<std::vector<Affine>> found = symmetry(word_, numbers_, lattice_, fault))
        add_unique(maps_, *found);
    else
        fail_(fault);
    word_.clear();
    numbers_.clear();
}

} // namespace graftal::cfdg
