// SVG of models in a plane: nested <use> for parts that repeat; or single strokes for a plotter.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "compiler/primitives/tessellate.h"
#include "compiler/unfolded/looks.h"
#include "runtime/export/formats/flat_files.h"
#include "runtime/export/formats/plane_view.h"
#include "runtime/export/formats/plotter.h"

namespace graftal {

namespace {

constexpr std::size_t most_svg_nodes = 500'000;
constexpr std::uint64_t svg_part_bytes = 90;
/// Length of the longer side of a plotted page where --unit does not say: it fits A4.
constexpr double plotted_page_mm = 180;
constexpr double pen_mm = 0.3;
constexpr std::size_t most_pen_strokes = 2'000'000;

std::string svg_number(double value) {
    return fmt::format("{:.7g}", value + 0.0);
}

std::string svg_colour(Rgb linear) {
    const auto [r, g, b] = srgb_bytes(linear);
    return fmt::format("#{:02x}{:02x}{:02x}", r, g, b);
}

std::string svg_matrix(const Affine2& map) {
    std::string text = "matrix(";
    for (const double entry : map.linear)
        text += svg_number(entry) + " ";
    return text + svg_number(map.translation[0]) + " " + svg_number(map.translation[1]) + ")";
}

std::string svg_points(const std::vector<Point2>& points) {
    std::string text;
    for (const Point2& p : points)
        text += (text.empty() ? "" : " ") + svg_number(p[0]) + "," + svg_number(p[1]);
    return text;
}

/// Comments end at two dashes.
std::string svg_comment(std::string text) {
    for (std::size_t at; (at = text.find("--")) != std::string::npos;)
        text.replace(at, 2, "- -");
    return text;
}

void svg_head(OutputFile& file, const ExportJob& job, const PlanePage& page, std::string_view size_unit,
              double size_of_unit) {
    file.print("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
               "width=\"{0}{4}\" height=\"{1}{4}\" viewBox=\"0 0 {2} {3}\">\n",
               svg_number(page.width * size_of_unit), svg_number(page.height * size_of_unit),
               svg_number(page.width), svg_number(page.height), size_unit);
    for (const std::string& line : comment_lines(job.options.metadata))
        file.print("<!-- {} -->\n", svg_comment(line));
}

/// Largest deviation from a right angle between a direction and an axis, as a cosine.
constexpr double from_the_side = 1e-6;

bool is_convex(PrimitiveKind kind) {
    switch (kind) {
    case PrimitiveKind::triangle:
    case PrimitiveKind::sphere:
    case PrimitiveKind::cube:
    case PrimitiveKind::cylinder:
    case PrimitiveKind::cone:
    case PrimitiveKind::frustum:
        return true;
    case PrimitiveKind::plane:
    case PrimitiveKind::torus:
    case PrimitiveKind::superellipsoid:
    case PrimitiveKind::polygon:
    case PrimitiveKind::bicubic_patch:
    case PrimitiveKind::sphere_sweep:
    case PrimitiveKind::limb_sweep:
    case PrimitiveKind::mesh:
        return false;
    }
    return false;
}

/// The axis of what is long and round and seen from its side.
std::optional<std::array<Point2, 2>> axis_of(const SceneShape& shape, const SeenFrame& seen) {
    const PrimitiveKind kind = shape.primitive.kind();
    const bool is_long =
        kind == PrimitiveKind::cylinder || kind == PrimitiveKind::cone || kind == PrimitiveKind::frustum;
    if (!is_long || std::abs(seen.along().y) > from_the_side) return std::nullopt;
    return std::array{seen(Vec3(0.0)), seen(Vec3(0, 1, 0))};
}

/// A leaf as it is seen along a direction, in its own picture.
struct FlatShape {
    enum class Kind { stroke, disc, polygon, triangles };
    Kind kind = Kind::polygon;
    Point2 from{0, 0}, to{0, 0}; ///< of a stroke, 2 wide, with flat ends; where its axis is
    std::vector<Point2> points;  ///< of a polygon its corners; of triangles three each; a disc has radius 1
};

FlatShape flat_shape(const SceneShape& shape, const SeenFrame& seen) {
    FlatShape flat;
    const PrimitiveKind kind = shape.primitive.kind();
    if (kind == PrimitiveKind::sphere) {
        flat.kind = FlatShape::Kind::disc;
        return flat;
    }
    if (const auto axis = axis_of(shape, seen); axis && kind == PrimitiveKind::cylinder) {
        flat.kind = FlatShape::Kind::stroke;
        flat.from = (*axis)[0];
        flat.to = (*axis)[1];
        return flat;
    }
    // Round parts are fine here, however small they are in the model: the file has each once.
    const int fineness = std::max(shape.fineness, std::min(3, max_fineness(shape.primitive)));
    const TessellatedPrimitive& mesh = tessellated(shape.primitive, fineness);
    std::vector<Point2> points;
    for (const Vec3& vertex : mesh.vertices)
        points.push_back(seen(vertex));
    if (is_convex(kind)) {
        flat.points = convex_outline(std::move(points));
        return flat;
    }
    flat.kind = FlatShape::Kind::triangles;
    for (const auto& t : mesh.triangles) {
        const Point2 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
        const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if (area == 0) continue;
        // All in one sense, so that where they overlap they stay filled.
        flat.points.push_back(a);
        flat.points.push_back(area > 0 ? b : c);
        flat.points.push_back(area > 0 ? c : b);
    }
    return flat;
}

/// A node as it is seen along a direction of its own.
struct SeenNode {
    SceneId node = 0;
    SeenFrame seen;
};

class SvgWriter {
  public:
    SvgWriter(const UnfoldedScene& scene, OutputFile& file) : scene_(scene), file_(file) {}

    /// False if there are too many.
    bool find_nodes(const PlanePage& page) {
        root_ = number_of({scene_.root, page.world});
        for (std::size_t next = 0; next < nodes_.size(); ++next) {
            const SeenNode at = nodes_[next]; // the list grows
            for (const ScenePart& part : scene_.nodes[at.node].parts) {
                const SeenFrame seen = at.seen.of_part(part.node_from_part);
                if (scene_.nodes[part.node].shape)
                    shape_number(*scene_.nodes[part.node].shape, seen);
                else
                    number_of({part.node, seen});
                if (nodes_.size() + shapes_.size() > most_svg_nodes) return false;
            }
        }
        return true;
    }

    std::uint64_t parts() const {
        std::uint64_t count = 0;
        for (const SeenNode& node : nodes_)
            count += scene_.nodes[node.node].parts.size();
        return count;
    }

    void write(const PlanePage& page) {
        file_.text("<defs>\n");
        for (std::size_t i = 0; i < shapes_.size(); ++i)
            shape(i);
        // Nodes that are met first use those that are met later.
        for (std::size_t i = nodes_.size(); i-- > 0;)
            if (i != root_) unite(i);
        file_.text("</defs>\n");
        file_.print("<g transform=\"{}\">\n", svg_matrix(page.page_from_world));
        parts_of(root_);
        file_.text("</g>\n");
    }

    std::string summary() const {
        return fmt::format("{} symbols of {} shapes", nodes_.size(), shapes_.size());
    }

  private:
    using SeenKey = std::pair<std::uint32_t, std::array<double, 3>>;
    static SeenKey key(std::uint32_t number, const SeenFrame& seen) {
        return {number, {seen.along().x, seen.along().y, seen.along().z}};
    }

    std::size_t number_of(const SeenNode& node) {
        const auto [known, is_new] = number_of_.try_emplace(key(node.node, node.seen), nodes_.size());
        if (is_new) nodes_.push_back(node);
        return known->second;
    }

    std::size_t shape_number(std::uint32_t shape, const SeenFrame& seen) {
        const auto [known, is_new] = shape_of_.try_emplace(key(shape, seen), shapes_.size());
        if (is_new) shapes_.emplace_back(shape, seen);
        return known->second;
    }

    void shape(std::size_t number) {
        const auto& [shape, seen] = shapes_[number];
        const FlatShape flat = flat_shape(scene_.shapes[shape], seen);
        switch (flat.kind) {
        case FlatShape::Kind::stroke:
            file_.print("<path id=\"s{}\" d=\"M{} {} {} {}\" stroke=\"currentColor\" stroke-width=\"2\"/>\n",
                        number, svg_number(flat.from[0]), svg_number(flat.from[1]), svg_number(flat.to[0]),
                        svg_number(flat.to[1]));
            return;
        case FlatShape::Kind::disc:
            file_.print("<circle id=\"s{}\" r=\"1\" fill=\"currentColor\"/>\n", number);
            return;
        case FlatShape::Kind::polygon:
            file_.print("<polygon id=\"s{}\" points=\"{}\" fill=\"currentColor\"/>\n", number,
                        svg_points(flat.points));
            return;
        case FlatShape::Kind::triangles:
            file_.print("<path id=\"s{}\" d=\"", number);
            for (std::size_t i = 0; i + 2 < flat.points.size(); i += 3)
                file_.print("M{}Z", svg_points({flat.points[i], flat.points[i + 1], flat.points[i + 2]}));
            file_.text("\" fill=\"currentColor\"/>\n");
            return;
        }
    }

    void unite(std::size_t number) {
        file_.print("<g id=\"n{}\">\n", number);
        parts_of(number);
        file_.text("</g>\n");
    }

    void parts_of(std::size_t number) {
        const SeenNode at = nodes_[number];
        std::string colour; // and clearness, of the group that is open
        const auto close = [&] {
            if (!colour.empty()) file_.text("</g>\n");
            colour.clear();
        };
        for (const ScenePart& part : scene_.nodes[at.node].parts) {
            const SceneNode& node = scene_.nodes[part.node];
            const SeenFrame seen = at.seen.of_part(part.node_from_part);
            const std::string place = svg_matrix(at.seen.picture_of(seen, part.node_from_part));
            if (!node.shape) {
                close();
                file_.print("<use href=\"#n{}\" transform=\"{}\"/>\n", number_of({part.node, seen}), place);
                continue;
            }
            const std::string own = look_of(node.look);
            if (own != colour) {
                close();
                colour = own;
                file_.print("<g {}>\n", colour);
            }
            file_.print("<use href=\"#s{}\" transform=\"{}\"/>\n", shape_number(*node.shape, seen), place);
        }
        close();
    }

    /// Attributes of a group of shapes: its colour and its opacity.
    std::string look_of(const SceneLook& look) const {
        std::string text = fmt::format("color=\"{}\"", svg_colour(look.colour()));
        const double clear = look.material ? scene_.materials[*look.material].transparency : 0;
        if (clear > 0)
            text += fmt::format(" fill-opacity=\"{0}\" stroke-opacity=\"{0}\"", svg_number(1 - clear));
        return text;
    }

    const UnfoldedScene& scene_;
    OutputFile& file_;
    std::vector<SeenNode> nodes_;
    std::map<SeenKey, std::size_t> number_of_;
    std::vector<std::pair<std::uint32_t, SeenFrame>> shapes_;
    std::map<SeenKey, std::size_t> shape_of_;
    std::size_t root_ = 0;
};

Status write_nested(const ExportJob& job, ExportReport& report) {
    const std::optional<PlanePage> page = page_of(job, std::nullopt);
    if (!page) return {};
    const std::optional<UnfoldedScene> scene =
        resolve_looks(job.scene, {most_svg_nodes}, job.model, job.diagnostics);
    job.too_large = !scene;
    if (!scene) return {};
    OutputFile file(job.options.output, job.options.most_bytes, job.too_large);
    if (!file.ok()) return file.status();
    SvgWriter writer(*scene, file);
    const bool fits = writer.find_nodes(*page);
    if (!fits || writer.parts() * svg_part_bytes > job.options.most_bytes) {
        refuse_as_too_large(job,
                            fmt::format("'{}' would have {}{} parts, about {} bytes", job.options.output,
                                        fits ? "" : "more than ", writer.parts(),
                                        writer.parts() * svg_part_bytes),
                            "leave out more with a larger --error or fewer --steps");
        return {};
    }
    if (job.options.unit_mm)
        svg_head(file, job, *page, "mm", *job.options.unit_mm / page->scale);
    else
        svg_head(file, job, *page, "", 1);
    writer.write(*page);
    file.text("</svg>\n");
    const Status status = file.close();
    if (!status.ok()) return status;
    report.summary = writer.summary();
    return file.pending().commit();
}

/// The strokes of each colour, on the page.
using PenStrokes = std::map<std::string, std::vector<PenStroke>>;

bool gather_strokes(const ExportJob& job, const PlanePage& page, PenStrokes& strokes) {
    // A ball no wider than the lines is where two of them meet.
    double widest = 0;
    const auto width_of = [](const Affine2& picture) {
        return 2 * std::hypot(picture.linear[0], picture.linear[1]);
    };
    std::size_t count = 0;
    const auto each = [&](const auto& visit) {
        return walk_leaves(job.scene, job.scene.root, {}, {}, [&](const SceneLeaf& leaf) {
            const SeenFrame seen = page.world.of_part(leaf.world_from_shape);
            const Affine2 picture = page.page_from_world * page.world.picture_of(seen, leaf.world_from_shape);
            return visit(leaf, seen, picture);
        });
    };
    each([&](const SceneLeaf& leaf, const SeenFrame& seen, const Affine2& picture) {
        if (const auto axis = axis_of(job.scene.shapes[leaf.shape], seen)) {
            const Point2 from = (*axis)[0], to = (*axis)[1];
            const Point2 across{-(to[1] - from[1]), to[0] - from[0]};
            const Point2 origin = picture({0, 0}), side = picture(across);
            widest = std::max(widest, 2 * std::hypot(side[0] - origin[0], side[1] - origin[1]));
        }
        return ++count <= most_pen_strokes;
    });
    if (count > most_pen_strokes) return false;
    each([&](const SceneLeaf& leaf, const SeenFrame& seen, const Affine2& picture) {
        const SceneShape& shape = job.scene.shapes[leaf.shape];
        PenStroke stroke;
        if (const auto axis = axis_of(shape, seen)) {
            stroke = {picture((*axis)[0]), picture((*axis)[1])};
        } else if (shape.primitive.kind() == PrimitiveKind::sphere) {
            if (width_of(picture) <= widest * (1 + 1e-6)) return true;
            constexpr int sides = 48;
            for (int i = 0; i <= sides; ++i) {
                const double angle = 2 * std::numbers::pi * (i % sides) / sides;
                stroke.push_back(picture({std::cos(angle), std::sin(angle)}));
            }
        } else {
            const FlatShape flat = flat_shape(shape, seen);
            const std::vector<Point2> outline =
                flat.kind == FlatShape::Kind::polygon ? flat.points : convex_outline(flat.points);
            for (const Point2& p : outline)
                stroke.push_back(picture(p));
            if (!stroke.empty()) stroke.push_back(stroke.front());
        }
        strokes[svg_colour(leaf.look.colour())].push_back(std::move(stroke));
        return true;
    });
    return true;
}

Status write_plotted(const ExportJob& job, ExportReport& report) {
    std::optional<PlanePage> page = page_of(job, job.options.unit_mm);
    if (!page) return {};
    if (!job.options.unit_mm)
        page = page_of(job, page->scale * plotted_page_mm / std::max(page->width, page->height));
    PenStrokes strokes;
    if (!gather_strokes(job, *page, strokes)) {
        refuse_as_too_large(
            job,
            fmt::format("'{}' would have {} strokes, more than {}", job.options.output,
                        in_words(sum_over_leaves(job.scene, [](const SceneShape&) { return 1; })),
                        most_pen_strokes),
            "leave out more with a larger --error or fewer --steps");
        return {};
    }
    OutputFile file(job.options.output, job.options.most_bytes, job.too_large);
    if (!file.ok()) return file.status();
    svg_head(file, job, *page, "mm", 1);
    std::size_t lines = 0;
    double lifted = 0, before = 0;
    for (auto& [colour, list] : strokes) {
        before += lifted_length(list);
        const std::vector<PenStroke> path = pen_path(std::move(list), 1e-3 * pen_mm);
        lifted += lifted_length(path);
        lines += path.size();
        file.print("<g fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" "
                   "stroke-linejoin=\"round\">\n",
                   colour, svg_number(pen_mm));
        for (const PenStroke& stroke : path)
            file.print("<path d=\"M{}\"/>\n", svg_points(stroke));
        file.text("</g>\n");
    }
    file.text("</svg>\n");
    const Status status = file.close();
    if (!status.ok()) return status;
    report.summary =
        fmt::format("{} strokes in {} colours on {:.3g} x {:.3g} mm; the pen is lifted for {:.3g} mm, "
                    "in the model's order for {:.3g} mm",
                    lines, strokes.size(), page->width, page->height, lifted, before);
    return file.pending().commit();
}

Status write_svg(const ExportJob& job, ExportReport& report) {
    if (refuse_range(job, 1)) return {};
    return job.options.plotter ? write_plotted(job, report) : write_nested(job, report);
}

} // namespace

const ExportFormat svg_format = {
    .extension = ".svg",
    .name = "SVG",
    .summary = "models in a plane, parts that repeat once; or single strokes for a plotter",
    .has_unit = true,
    .has_plotter = true,
    .write = write_svg,
};

} // namespace graftal
