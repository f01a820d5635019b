#pragma once

#include <memory>
#include <mutex>

#include "compiler/light/sky_light.h"
#include "compiler/support/control.h"

namespace graftal {

/// One layer of clouds over a sky, seen from below.
struct Clouds {
    double cover = 0;     ///< the share of the layer that they take, in [0, 1]; 0: none
    double turn_deg = 0;  ///< of the layer about the vertical: other turns show other clouds
    Vec3 to_sun{0, 1, 0}; ///< unit
    Rgb sun_rgb{0.0};     ///< light of that sun: what white paper at right angles to it shows
    bool operator==(const Clouds&) const = default;
};

/// Rows of a sky's picture, all round; it has twice as many columns.
inline constexpr int most_cloud_rows = 1024;

/// The light of the sky above the horizon with clouds before it; below, the sky as it is. The layer is a
/// sphere about a large planet, so that clouds are smaller and paler towards the horizon. How thick they are
/// is a sum of gradient noise (Perlin, "Improving noise", 2002) of falling wavelengths; light comes through
/// them and is scattered forwards by Henyey and Greenstein's function (1941), and is lost on its way from the
/// sun. No measured sky: a likeness. Requires an upright sky that shows no picture. The same values give the
/// same texels. Throws Cancelled within a row of texels after `cancel` is raised.
std::shared_ptr<const SkyPicture> cloudy_picture(const SkyLight& sky, const Clouds& clouds,
                                                 int rows = most_cloud_rows, const CancelFlag& cancel = {});

/// Rows for a picture that may take so many seconds of one processor: a sixth of them at most go to its sky,
/// down to 128 rows.
int cloud_rows(double work_seconds);

/// The last cloudy_picture(), as long as somebody uses it: framing asks for it several times, and the
/// pictures of a film have one sky. Many threads may ask.
class CloudPictures {
  public:
    /// From its beginning on pictures have so many rows; until its end the flag ends the drawing of one by
    /// Cancelled.
    class Drawing {
      public:
        Drawing(CloudPictures& pictures, int rows, CancelFlag cancel);
        ~Drawing();
        Drawing(const Drawing&) = delete;
        Drawing& operator=(const Drawing&) = delete;

      private:
        CloudPictures& pictures_;
        const int rows_;
    };

    std::shared_ptr<const SkyPicture> picture(const SkyLight& sky, const Clouds& clouds);

  private:
    void set(int rows, CancelFlag cancel);

    std::mutex mutex_;
    int rows_ = most_cloud_rows;
    CancelFlag cancel_;
    SkyLight sky_;
    Clouds clouds_;
    int picture_rows_ = 0;
    std::weak_ptr<const SkyPicture> picture_;
};

} // namespace graftal
