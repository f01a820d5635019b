#pragma once

#include <functional>
#include <string>
#include <vector>

#include "compiler/support/control.h"
#include "compiler/support/status.h"
#include "runtime/image_files/image_files.h"

namespace graftal {

struct SheetPicture {
    std::string path;  ///< an sRGB PNG
    std::string label; ///< the value that it shows: "seed=12"
};

/// Puts many pictures on one, row by row from the top left. Each is reduced by a whole factor until it fits
/// into a cell, by the mean light of its pixels. It lies in the middle on white, above its label. A label
/// that does not fit ends with "..". The sheet is at most 8192 pixels wide, with `columns` pictures
/// a row, of which one is in memory at a time. `on_picture` hears how many are done. A raised flag ends it:
/// "interrupted".
Status write_contact_sheet(const std::string& path, const std::vector<SheetPicture>& pictures,
                           std::uint64_t columns, const ImageMetadata& metadata, const CancelFlag& cancel,
                           const std::function<void(std::size_t)>& on_picture = {});

} // namespace graftal
