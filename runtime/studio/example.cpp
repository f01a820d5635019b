#include "runtime/studio/example.h"

namespace graftal {

OpenedModel example_model() {
    return {"crystal.rifs", R"(let spread = 0.5

rifs crystal {
  map n { scale 1/2  translate <0,  spread, 0>  tint rgb <0.2, 0.5, 0.9> 0.5 }
  map s { scale 1/2  translate <0, -spread, 0>  tint rgb <0.1, 0.2, 0.6> 0.5 }
  map e { scale 1/2  translate < spread, 0, 0> }
  map w { scale 1/2  translate <-spread, 0, 0> }
  map f { scale 1/2  translate <0, 0,  spread>  tint rgb <1, 0.6, 0.1> 0.5 }
  map b { scale 1/2  translate <0, 0, -spread> }
  terminal sphere
}
)"};
}

} // namespace graftal
