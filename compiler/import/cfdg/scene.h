#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/import/cfdg/evaluate/evaluator.h"
#include "compiler/import/cfdg/parse/ast.h"
#include "compiler/import/cfdg/symmetry.h"
#include "compiler/import/importer.h"
#include "compiler/support/number.h"

namespace graftal::cfdg {

/// The text of a translation, its scene, and the primitives.
class SceneWriter {
  protected:
    /// Both must outlive this.
    SceneWriter(const ForeignFile& file, const Grammar& grammar);

    void check_definitions();
    /// Background, camera, light and material.
    void write_scene();
    /// The drawn object: copies of `instance`, which has its moves, under the symmetries and on all tiles.
    /// `inks` changes black.
    void write_start(const std::string& instance, const std::string& inks);
    /// The definitions of the primitives that are used, and the comments at the end of the file.
    void write_end();
    /// The object for a primitive.
    std::string primitive(std::string_view kind);

    std::string free_name(std::string_view wanted);
    void fail(Span span, std::string message, std::string hint = {});
    void fail_without_start();
    void comment(const std::string& words);
    void line(const std::string& words, Span origin = {});

    const ForeignFile& file_;
    const Grammar& grammar_;
    Evaluator evaluator_;
    Translation out_{.extension = "inst"};
    int depth_ = 0;
    double camera_height_ = 10;
    bool translucent_ = false;   ///< some colours are
    std::vector<Affine> copies_; ///< of the whole: tiles, and by symmetry
    double copy_step_ = 0;       ///< of a copy of the whole over the one before it
    bool deep_ = false;          ///< some shapes move in depth
    /// The view of a grammar that says none: where the bounds do not give it. Half of its size.
    std::optional<std::pair<Vec3, Vec3>> middle_and_half_;

  private:
    void write_camera();
    void read_symmetry(const Definition& definition);
    void add_tiles();
    static std::string disc_text();

    std::set<std::string> names_;
    std::map<std::string, std::string> primitives_; ///< primitives in use
    Lattice lattice_;
};

} // namespace graftal::cfdg
