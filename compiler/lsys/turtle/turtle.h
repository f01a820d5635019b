#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compiler/lsys/parse/turtle_command.h"
#include "compiler/lsys/turtle/bodies.h"
#include "compiler/lsys/turtle/length_tally.h"
#include "compiler/lsys/turtle/limb.h"
#include "compiler/lsys/turtle/model_placer.h"
#include "compiler/lsys/turtle/state.h"
#include "compiler/support/big_count.h"
#include "compiler/support/diagnostics.h"

// The turtle (ABOP, sections 1.5 and 1.6, appendix C; docs/language.md, "The turtle").

namespace graftal {

/// Bounds on the distance of things from where they belong.
struct Displacement {
    double exit_turn = 0;  ///< of the exit's orientation, radians
    double exit_shift = 0; ///< of the exit's position
    double farthest = 0;   ///< of any point
};

/// Where a width comes from, and so what it is off by if that is off.
enum class WidthSource : std::uint8_t {
    start, ///< the width that came in
    unit,  ///< the text, in units
    sizes, ///< parameters that are sizes
};

/// The drawing of a string of modules, in the frame of the turtle at its start, and the state it leaves.
struct TurtlePart {
    std::vector<Instance> instances;
    /// The end of a polygon that was open at the start: its last vertices, drawn in this colour.
    struct PolygonEnd {
        std::vector<Vec3> vertices;
        int colour = 0;
    };
    std::vector<PolygonEnd> polygon_ends;
    std::vector<Vec3> vertices; ///< for the polygon that is then the innermost
    /// A polygon that is open, with the axes of the turtle where it began.
    struct OpenPolygon {
        Mat3 axes{1.0};
        std::vector<Vec3> vertices;
    };
    std::vector<OpenPolygon> polygons; ///< left open
    /// With a skin: the limb that goes on with the one at the start; then, if that ends in the part, the one
    /// that is open at the exit.
    std::vector<Limb> limbs;
    Affine start_from_exit;    ///< without the scale
    double exit_scale = 1;     ///< of what follows
    bool mirrors = false;      ///< the exit is a mirror image
    TurtleState exit;          ///< the members of `writes` only
    TurtleStateMask reads = 0; ///< before they were written
    TurtleStateMask writes = 0;
    bool cut = false;        ///< the rest of the branch is cut off
    double reach = 0;        ///< the turtle goes no farther from the start
    double longest_way = 0;  ///< nor is any way that it goes longer
    double exit_way = 0;     ///< how long the way to the exit is
    Displacement error;      ///< from directions that were snapped and sizes that were rounded (LsysComposer)
    Displacement size_error; ///< the sizes' share in it; its turn is 0
    Displacement sensitivity; ///< to the directions at the start, per radian, to first order
    /// Sensitivities to the width that came in, and to the unit, by their logarithms (LsysComposer).
    double width_sensitivity = 0;  ///< of any point
    Displacement unit_sensitivity; ///< its turn is 0
    double thickest = 0;           ///< the largest radius that is drawn
    WidthSource exit_width_source = WidthSource::start;
    double exit_width_error = 0; ///< of the logarithm
    bool has_bodies = false;     ///< there are more than segments to see
    LengthTally lengths;         ///< of the segments, if TurtleContext::tallies
    BigCount modules = 0;
    BigCount segments = 0;
    BigCount bodies = 0;    ///< spheres, discs, models and polygons
    std::uint32_t sums = 0; ///< the number that a witness gave it (WordWitness::sums())

    std::size_t limb_node_count() const {
        std::size_t count = 0;
        for (const Limb& limb : limbs)
            count += limb.nodes.size();
        return count;
    }
    /// Vertices of the polygons that begin or end outside of the part.
    std::size_t vertex_count() const {
        std::size_t count = vertices.size();
        for (const PolygonEnd& end : polygon_ends)
            count += end.vertices.size();
        for (const OpenPolygon& polygon : polygons)
            count += polygon.vertices.size();
        return count;
    }
};

/// The way in which a part is placed.
struct Placing {
    double snap = 0;       ///< angle by which its directions are off
    double scale = 1;      ///< factor of its size
    bool absolute = false; ///< the scale is one in units
    // Differences of logarithms between the values here and those that the part was composed for:
    double width_error = 0; ///< of the width that came in
    double unit_error = 0;  ///< of the unit
    double size_error = 0;  ///< of parameters that reach nothing but widths
};

/// Most items that are packed; each takes 64 bytes.
inline constexpr std::size_t max_packed_items = 32'000'000;

/// The state that all turtles of a model share.
struct TurtleContext {
    TurtleBodies& bodies;
    Diagnostics& diagnostics;
    double angle_deg = 90;
    double step = 1;
    bool varies_step = false;    ///< symbols multiply it
    bool relative_width = false; ///< widths are per length
    double thinnest = 0;         ///< then the least
    double taper = 1;            ///< of the width, where a branch begins
    bool varies_angle = false;   ///< symbols multiply it
    bool reverses_turns = false;
    bool two_headings = false;             ///< symbols exchange them
    std::span<const TropismKind> tropisms; ///< empty: one that is plain
    Bending bending = Bending::after_segments;
    int skin = 0;       ///< sides of the skin of limbs; 0: segments are bodies of their own
    bool draws = true;  ///< or only walks, for queries
    bool lines = false; ///< segments are strokes of a curve: small parts are drawn as lines
    bool limit = false; ///< only proportions count: lines are as thick as their lengths ask, and parts that
                        ///< differ by a rotation in the plane are made equal
    bool open_width = false;               ///< how thick lines are is not known yet (bodies.h)
    bool tallies = false;                  ///< the lengths of segments are tallied
    std::size_t max_instances = 4'000'000; ///< of one part, its polygons' vertices too
};

/// Two directions are no farther apart than this, as ends of unit vectors. So what an angle displaces is at
/// most twice the way that is gone under it, however large a bound of first order is.
inline constexpr double farthest_directions = 2;

/// Sensitivities multiply from turn to turn: without a bound they would come to be infinite, and no number
/// once they are multiplied by an angle of 0.
inline double bounded(double sensitivity) {
    return std::min(sensitivity, 1e100);
}

/// Follows commands and gathers what they draw.
class Turtle {
  public:
    /// `context` must outlive the turtle; `start` has a frame if symbols ask for the world.
    Turtle(TurtleContext& context, const TurtleState& start);

    /// Carries out one module; false after an error. `model` is what `~` places. `absolute`: the parameter
    /// is a size in units.
    bool run(TurtleCommand command, std::span<const double> parameters,
             const std::optional<PlacedModel>& model, Span span, bool absolute = false);

    /// Places a part whose entry state was scaled(state(), 1 / scale), except for what the placing says:
    /// draws it, and goes where it leaves the turtle.
    void append(const TurtlePart& part, Span span, const Placing& placing = {});
    /// Places a part as a branch, which leaves the turtle as it is.
    void append_branch(const TurtlePart& part, Span span, const Placing& placing = {});

    /// Begins and ends a branch, as `[` and `]` do.
    void open_branch();
    void close_branch();

    /// Draws the limbs that are open, where a whole word ends. Requires a skin.
    void end_limbs();

    /// Notes that what is drawn depends on state().variant.
    void read_variant() { note(reads_variant); }
    /// Notes that what is drawn depends on state().birth.
    void read_birth() { note(reads_birth); }

    /// False after the error that there is too much, or that it lies too far; run() looks at it, append()
    /// does not.
    bool within_limits(Span span);

    /// The state of a part that begins here.
    TurtleState state() const;
    double unit() const { return state_.unit; }
    double scale() const { return scale_; } ///< by which lengths are longer here
    bool is_scaled() const { return scale_ != 1; }
    /// The diameter of a segment from here on; where widths are per length, of one that is a step long.
    double diameter() const {
        return context_.relative_width ? state_.width * scale_ * context_.step * state_.unit : state_.width;
    }
    const Affine& start_from_turtle() const { return start_from_turtle_; }
    /// Work of all polygons so far, as TurtleBodies counts it.
    std::size_t polygon_work() const { return context_.bodies.polygon_work(); }
    /// True where modules are cut off: run() and append() pass over them, but watch the brackets.
    bool passing_over() const { return cut_depth_ > 0; }
    /// True if nothing that follows counts.
    bool finished() const { return cut_depth_ > 0 && branches_.empty(); }

    /// The part; the turtle is used up.
    TurtlePart finish() &&;

  private:
    /// The distance of the turtle itself from where it belongs.
    struct Drift {
        double turn = 0;
        double shift = 0;

        double at(double distance) const { return shift + turn * distance; }
    };

    struct Branch {
        Affine start_from_turtle;
        TurtleState state;
        TurtleStateMask writes;
        Drift error, sensitivity;
        double way, size_shift, unit_shift, width_error, scale;
        Mat3 second;
        bool mirrored;
        WidthSource width_source;
        std::size_t polygons = 0; ///< open ones
        Limb limb;
    };

    /// Axes of the turtle, in the order of the columns of its frame.
    enum class Axis { right, ahead, up };

    bool in_range(TurtleCommand command, std::span<const double> parameters,
                  const std::optional<PlacedModel>& model, Span span);
    bool pass_over(TurtleCommand command);
    void move(std::span<const double> parameters, bool absolute, bool draw, bool record, Span span,
              bool always = false);
    double usual_angle();
    double written(double length);
    double usual_diameter();
    bool scale_by(double factor, bool written_too, Span span);
    /// Always false.
    bool report_scale(Span span);
    void bend_down(double elasticity);
    bool set_tropism(std::span<const double> parameters, Span span);
    void go_to(std::span<const double> parameters);
    bool head_to(std::span<const double> parameters, Span span);
    void turn_to(Vec3 heading);
    bool widen(double by, Span span);
    void taper();
    bool widen_by(double factor, Span span);
    bool multiply_angle(double factor, Span span);
    double sense();
    void reverse_turns(std::span<const double> parameters);
    void exchange();
    void flip();
    Placing in_frame(Placing placing) const { return placing.scale *= scale_, placing; }
    void turn(Axis axis, double angle_deg);
    void level();
    void bend();
    void bend_to_all();
    void twist_to(Vec3 pull);
    bool set_width(std::span<const double> parameters, bool absolute, Span span);
    void add_ball(TurtleCommand command, std::span<const double> parameters, bool absolute, Span span);
    void add_model(const PlacedModel& model, bool absolute, Span span);
    void note_radius(double radius, WidthSource source);
    void place_errors(const TurtlePart& part, const Placing& placing);
    void take_tropisms(const TurtleFrame& exit);
    void take_exit_width(const TurtlePart& part, const Placing& placing);
    void set_colour(std::span<const double> parameters, int step);
    void cut();
    void close_polygon(int colour, Span span);
    void record_vertex(Vec3 vertex);
    void append_polygons(const TurtlePart& part, double scale, Span span);
    void extend_limb(const LimbNode& from, const LimbNode& to, int colour, Span span);
    void add_segment_to_limb(double length, double width, Span span);
    void stand_on(const LimbNode& node);
    void set_limb_radius(double radius);
    void end_limb();
    Limb branch_off();
    void append_limbs(const TurtlePart& part, double scale, Span span);
    void start_cylinder();
    void add_control_point(Span span);

    double line_width(double length);
    double read_width() { return note(reads_width), state_.width; }
    double read_unit() { return note(reads_unit), state_.unit; }
    int read_colour() { return note(reads_colour), state_.colour; }
    void note(TurtleStateMask bits) { part_.reads |= static_cast<TurtleStateMask>(bits & ~writes_); }

    /// `by_width`: of a body that is as thick as a line.
    BodySink sink(bool by_width) { return {part_.instances, by_width && context_.open_width}; }

    TurtleContext& context_;
    Affine start_from_turtle_; ///< by a rotation, or a mirrored one
    double scale_ = 1;         ///< by which lengths are longer
    Mat3 second_;              ///< the second axes, in the frame of the start
    bool mirrored_ = false;    ///< as seen from the start
    TurtleState state_;        ///< directions in the frame of the start, as they came in
    TurtleStateMask writes_ = 0;
    double way_ = 0;        ///< how far the turtle has gone to here
    double size_shift_ = 0; ///< the share of rounded sizes in error_.shift
    Drift error_;           ///< from parts before that were snapped
    Drift sensitivity_;     ///< per radian of the directions at the start
    double unit_shift_ = 0; ///< how far the place moves with the logarithm of the unit
    WidthSource width_source_ = WidthSource::start; ///< of the width now
    double width_error_ = 0;                        ///< of its logarithm, by parts before
    Limb limb_{.base = Limb::Base::entry};          ///< that ends here
    std::vector<Branch> branches_;
    std::vector<TurtlePart::OpenPolygon> polygons_;
    std::size_t cut_depth_ = 0; ///< 1 + branches opened since the cut; 0: no cut
    std::size_t vertex_count_ = 0;
    std::size_t longest_polygon_ = 0;                       ///< by vertices seen here
    std::uint64_t modules_ = 0, segments_ = 0, bodies_ = 0; ///< of run(); not of parts
    TurtlePart part_;
};

} // namespace graftal
