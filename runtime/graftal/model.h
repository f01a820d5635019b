#pragma once

// graftal as a library: a model that is loaded, changed and drawn. This header names no type of the
// compiler's own, so that those may change. docs/library.md has a whole program.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Seen from outside of the shared library.
#define GRAFTAL_API __attribute__((visibility("default")))

namespace graftal::v1 {

struct Vector {
    double x = 0, y = 0, z = 0;
};

/// A camera. The model fills values left open, or else graftal, so that the whole model is in the picture.
struct Camera {
    std::optional<Vector> location;
    std::optional<Vector> look_at;
    std::optional<Vector> up;
    std::optional<double> angle_deg; ///< horizontal angle of view, between 0 and 180
    bool orthographic = false;
    std::optional<double> width; ///< orthographic: of the view, in the model's units
};

enum class Severity { error, warning, note };
/// "error", "warning" or "note".
GRAFTAL_API const char* name_of(Severity severity);

/// One thing that is said about a model, or about the files and programs that it needs.
struct Message {
    Severity severity = Severity::error;
    std::string file;              ///< empty where no text is at fault
    unsigned line = 0, column = 0; ///< from 1; 0 without a file
    std::string text;
    std::string hint; ///< a text to write instead; may be empty
};

/// One a line, "crystal.rifs:3:5: error: ..."; hints have lines of their own.
GRAFTAL_API std::string text_of(const std::vector<Message>& messages);

/// A function's value, or the reasons why there is none. With a value there may be warnings and notes.
template<typename Value> struct Result {
    std::optional<Value> value;
    std::vector<Message> messages;
    bool cancelled = false; ///< the reason why there is no value

    std::string text() const { return text_of(messages); }
    explicit operator bool() const { return value.has_value(); }
    const Value& operator*() const { return *value; }
    const Value* operator->() const { return &*value; }
};

/// A number of a model that set() replaces: a `let`, an inner parameter, or a setting of an L-system.
struct Parameter {
    std::string name;
    double value = 0;                  ///< as it is set, or else as the text has it
    std::optional<double> least, most; ///< of an inner parameter
    bool literal = false;              ///< the text has a number there, and not an expression
    std::string file;                  ///< place of the value in the text
    unsigned line = 0, column = 0;     ///< from 1
    std::size_t begin = 0, end = 0;    ///< bytes of the value in the text; the end is after the last
};

/// The numbers that `graftal stats` prints.
struct Stats {
    std::size_t objects = 0;
    std::size_t instances = 0;     ///< edges of the graph
    std::optional<unsigned> steps; ///< nothing: without an end
    std::string primitives; ///< shapes after unfolding, to the last digit; empty where they have no end
    std::optional<double> dimension;
    std::optional<Vector> least, most; ///< corners of the box that holds it
    std::string json;                  ///< all of it, as `graftal stats --json` prints it
};

/// An instance of the graph: a part of an object.
struct GraphInstance {
    std::size_t parent = 0, child = 0; ///< objects
    double parent_from_child[12] = {}; ///< an affine map, by rows: x' = m[0] x + m[1] y + m[2] z + m[3]
    double tint[4] = {}; ///< red, green, blue (linear) and alpha, in front of what the child has
};

/// The graph that a model becomes, after the passes. Objects with instances of each other, perhaps in
/// circles.
struct ObjectGraph {
    std::size_t root = 0;
    std::vector<std::string> objects;    ///< names
    std::vector<std::string> primitives; ///< one an object: "sphere", or "" of a union of instances
    std::vector<GraphInstance> instances;
};

/// The modules of the word that an L-system derives, one row each, in its order (docs/export.md).
struct PlantTable {
    std::vector<std::string> names;
    std::vector<std::int64_t> parents; ///< rows; -1 of the first
    std::vector<bool> branches;        ///< begins a branch of its parent, or follows it on the same axis
    std::vector<std::int64_t> orders, ranks;
    std::vector<std::int64_t> parts_of; ///< the row of the module in whose place it is drawn; -1: none
    std::vector<std::string> organs;    ///< "segment", "ball", "disc", "polygon", "model"; "": draws nothing
    std::vector<std::string> materials; ///< "": none
    std::vector<double> ages;           ///< -1: not known
    std::vector<double> starts, ends, headings, lefts, ups; ///< x, y, z of each
    std::vector<double> lengths, widths;
    std::vector<double> areas, volumes; ///< NaN: not known
    std::size_t parameter_count = 0;
    std::vector<double> parameters; ///< parameter_count of each; those that a module has not are NaN
};

/// Settings of measures().
struct MeasureSettings {
    std::optional<double> ground_area; ///< above 0; nothing: the crown's convex hull, seen from above
    bool irradiance = false;           ///< the light on each organ, too
    /// Samples of each organ, as far as work() allows; at least 4. 0: until the organs' light has a standard
    /// error of 1 % of its mean.
    int samples = 0;
};

/// Measures of the plant that an L-system draws (docs/export.md).
struct PlantReport {
    std::string json; ///< as `graftal stats --plant --json` prints it
    /// Light, if it was asked for: a row for each of plant(). An open horizontal plane has 1; NaN where
    /// nothing is known.
    std::vector<float> lights, errors, absorbed, sunlit;
};

/// Points of a model by random iteration.
struct Points {
    std::vector<float> places;     ///< x, y, z of each
    std::vector<std::uint8_t> rgb; ///< of each, as sRGB
};

enum class Quality { draft, normal, best };

/// A picture as sRGB, 8 bits a sample, row by row, the top first.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb; ///< 3 width height samples
};

/// A picture with what its samples meet: the channels that docs/native.md lists under `--aovs`.
struct Channels {
    int width = 0, height = 0;
    std::vector<std::string> names;   ///< "R", "G", "B" (linear light), "A", "coverage", "Z", ...
    std::vector<float> samples;       ///< the channels of a pixel together, row by row, the top first
    std::vector<std::string> objects; ///< names by the channel "id": the first is that of 1
};

/// A part of a picture as it is drawn: linear light, not clamped, 3 floats a pixel.
struct Tile {
    int x = 0, y = 0, width = 0, height = 0; ///< pixels of the whole picture
    const float* rgb = nullptr;              ///< of the first pixel, while the listener runs
    std::size_t row_floats = 0;              ///< from one row to the next
    int pass = 0;                            ///< from 0; each pass covers the whole picture, and is finer
};

/// Called for one tile at a time, perhaps by a thread of the library's own.
using OnTile = std::function<void(const Tile&)>;

/// Counts of the stages that have run, since the model was made.
struct Runs {
    std::uint64_t parsed = 0; ///< texts: each file by itself
    std::uint64_t lowered = 0, analysed = 0, prepared = 0;
};

struct Drawn {
    std::string path;   ///< empty for a picture in memory
    double seconds = 0; ///< of drawing
};

/// Settings of a file for another program. All but most_bytes are for some formats only.
struct ExportSettings {
    std::optional<double> unit_mm;    ///< millimetres of a unit of the model; else as the format has it
    std::optional<unsigned> levels;   ///< instances within instances, at most; at least 2
    std::optional<std::size_t> nodes; ///< at most, each the place of a mesh; 30,000 before
    bool instancing = false;          ///< glTF: a node a mesh, with a table of places
    bool plotter = false;             ///< SVG: each line once, in the order of a pen
    /// Most bytes of the file. A model that takes more, without an error_px(), loses small parts, with a
    /// warning, until the file has no more. With this default it has 128 MiB then. Else graftal refuses it.
    std::uint64_t most_bytes = std::uint64_t{1} << 30;
    bool irradiance = false; ///< `.csv`, `.json` and `.mtg`: the light on each organ, too
    /// glTF, pbrt and Mitsuba: names of objects that stay meshes of their own, such as the leaves of a tree;
    /// `*`: what each object draws itself.
    std::vector<std::string> parts;
};

enum class Engine {
    native, ///< graftal's own ray tracer
    povray, ///< a child process; needs the program `povray`
};

/// A listener to progress: a stage, as `graftal --time` names it, and a share from 0 to 1, or nothing where
/// nobody knows.
using OnProgress = std::function<void(std::string_view stage, std::optional<double> share)>;

/// A model and what is asked of it. Each function does again only what the changes since make necessary: a
/// new camera does not read, analyse or prepare the model again. To be used by one thread at a time, except
/// cancel(). Objects that were moved from may only be destroyed or assigned to.
class GRAFTAL_API Model {
  public:
    /// A file `.lsys`, `.rifs` or `.inst`, or one of another program that `graftal import` knows. It is read
    /// when it is needed first.
    static Model from_file(std::string path);
    /// A text. The ending of the name says the language; files that the text names are looked up beside it.
    static Model from_text(std::string name, std::string text);

    Model(Model&&) noexcept;
    Model& operator=(Model&&) noexcept;
    ~Model();

    // Settings. They run nothing.

    /// A file that the model names, or another model does: over the disk's, and from the next reload() on.
    void put_file(const std::string& path, std::string text);
    void edit(std::string text);                     ///< in place of the file's text
    void reload();                                   ///< reads the file, and those that it names, again
    void set(const std::string& name, double value); ///< a `let` of the model
    void unset(const std::string& name);
    void steps(std::optional<unsigned> steps); ///< nothing: as the model says
    void time(double steps); ///< steps() between two, such as 7.5, of an L-system. Requires steps >= 0
    void seed(std::optional<std::uint64_t> seed);
    void camera(const Camera& camera);
    /// The radius of the camera's lens, 0 for none, and the place that is sharp; nothing: as the model says.
    void lens(std::optional<double> aperture, const std::optional<Vector>& focus);
    void size(int width, int height);        ///< in pixels, each at least 1; 1280 x 720 before
    void zoom(std::optional<double> factor); ///< about the point looked at. Requires a positive factor
    void error_px(double pixels);            ///< graftal leaves out smaller parts; 0: none; 0.5 before
    void memory(std::uint64_t bytes);        ///< most bytes for drawing; 2 GiB before
    void work(double seconds);               ///< of one processor that a picture may take
    void threads(int count);                 ///< 0, as before: one a processor
    /// Up to 4^(depth - 1) samples a pixel, of a depth from 1 to 9 (others count as the nearest); nothing:
    /// one.
    void antialias(std::optional<int> depth);
    void quality(Quality quality); ///< how closely soft light is followed; normal before
    /// Files that the model names, and the model itself, must lie in this folder; "": anywhere.
    void root(std::string folder);

    // Results.

    /// In the order of the text.
    Result<std::vector<Parameter>> parameters();
    Result<Stats> stats();
    /// At most 10^7 instances.
    Result<ObjectGraph> graph();
    /// The string that an L-system derives, before interpretation; at most 5 million modules.
    Result<std::string> word();
    Result<PlantTable> plant();
    Result<PlantReport> measures(const MeasureSettings& settings = {});
    /// The points that `graftal points -o FILE.ply` writes, as many as were asked for; at most 10^9.
    Result<Points> points(std::uint64_t count);
    /// Draws into memory, by the native engine: the pixels of the `.png` that render_to() writes.
    Result<Picture> render();
    /// Draws into memory what each pixel shows, as `graftal render --aovs -o FILE.exr` writes it: light is
    /// not denoised.
    Result<Channels> aovs();
    /// Draws into the listener, pass after pass, by the native engine.
    Result<Drawn> draw(const OnTile& listener);
    /// Draws into a file, `.png` or `.exr`, which appears whole or not at all.
    Result<Drawn> render_to(const std::string& path, Engine engine = Engine::native);
    /// Writes a POV-Ray scene: `.pov`, or `.inc` to be included, and the pictures that it needs.
    Result<Drawn> compile_to(const std::string& path);
    /// Writes a file for another program, as `graftal export` does: `.usda`, `.gltf`, `.glb`, `.obj`, `.ply`,
    /// `.stl`, `.svg`, `.pbrt` or `.xml`; `.csv`, `.json` or `.mtg` for plant(). Small parts are left out of
    /// a model that ends only after error_px().
    Result<Drawn> export_to(const std::string& path, const ExportSettings& settings = {});

    Runs runs() const;

    /// Called now and then while the functions above work, perhaps from a thread of theirs, never twice at a
    /// time. Empty: nobody listens.
    void on_progress(OnProgress listener);
    /// Ends what another thread, or the listener, has under way, soon; does nothing if there is nothing.
    void cancel();

  private:
    struct Parts;
    explicit Model(std::unique_ptr<Parts> parts);

    std::unique_ptr<Parts> parts_;
};

} // namespace graftal::v1
