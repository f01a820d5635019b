// Data that the host fills in and the kernel reads: offsets in units of 16 bytes, and marks. C++ includes this
// text, too. World space has its origin at the camera here, so that what is near the eye keeps its digits.

#define NONE 0xffffffffu

// An entry of a box: its kind and its number.
#define ENTRY_NUMBER 0x3fffffffu
#define ENTRY_PART (1u << 30)
#define ENTRY_TRIANGLE (2u << 30)

// boxes[]: four children a node. Of each the lower corner and the entry, and the upper corner.
#define BOX_SIZE 8u

// parts[]: an instance as rays go through it. The rows of the linear part of child_from_parent, and with each
// an axis of the child's origin in the parent; then the stretch, the child, the material, and the levels with
// PART_OUTWARDS above them; then NODE_BALL and NODE_FACTS of the child again, which a ray so has at once.
#define PART_SIZE 6u
#define PART_LEVELS 0x3fffffffu
#define PART_OUTWARDS (1u << 31) // its rows are those of parent_from_child, as of what is crushed

// Parts as flat as CRUSHED get some thickness, so that rays keep their digits there; those as flat as SINGULAR are drawn
// as wide as least_width.h says: at most so much over their size, and without a width of the world so much. What lies
// inside is as much thinner.
#define CRUSHED 1e-5f
#define SINGULAR 1e-6f
#define THICKEST_CRUSHED 0.125f
#define THICKNESS_UNCULLED 1e-3f
#define THICKNESS_INSIDE 0.0625f

// lows[]: by part what single precision has lost of the first three entries; empty unless PAIRED.
#define LOW_SIZE 3u

// looks[], by part: its tint, the colour fixed and the share that is open to what lies below it; then of a
// primitive length_in_turns(), and of a part that stands for two the one before and the last, or NONE.
#define LOOK_SIZE 2u

// nodes[]: an object in its own frame.
#define NODE_SIZE 9u
#define NODE_BALL 0u    // centre, radius
#define NODE_FACTS 1u   // cut_detail (0: never cut), flags, tree of its parts, tree of what is drawn where it is cut
#define NODE_PROXY 2u   // three rows of proxy_from_node
#define NODE_MEAN 5u    // the mean colour: what is fixed, and how much is open
#define NODE_STANDIN 6u // likewise, of its proxy; of a primitive half of its extents, and w: 1 if it is bounded
#define NODE_LOOK 7u    // the proxy's material, how far what it draws reaches from the ball's centre, the radius at the end
                        // of what tapers, of a primitive the radius of the largest ball in it; of a mesh 1 where its
                        // material says how many pictures lie along u, and likewise v
#define NODE_CELLS 8u   // where its cells of several levels begin in nodes[], the deepest first, and how many there are; of
                        // each FlatCell the least size, the reach, the tree, the least steps

// Flags of a node. The lowest bits are the kind of a primitive.
#define NODE_KIND 0xffu
#define NODE_UNENDING (1u << 8)
#define NODE_TERMINAL (1u << 9) // where it is cut, what names no material shows its mean colour
#define NODE_PRIMITIVE (1u << 10)
#define NODE_FAINT (1u << 11)  // a set without area
#define NODE_WIDENS (1u << 12) // holds such a set, or what is crushed, which are drawn wider than they are
#define NODE_SOLID (1u << 13)  // of primitives: has an inside

// Kinds of primitives, in the order of GRAFTAL_PRIMITIVE_KINDS; those that the kernel meets as meshes are one.
#define KIND_TRIANGLE 0u
#define KIND_SPHERE 1u
#define KIND_CUBE 2u
#define KIND_PLANE 3u
#define KIND_CYLINDER 4u
#define KIND_CONE 5u
#define KIND_TORUS 6u
#define KIND_FRUSTUM 7u
#define KIND_MESH 8u

// triangles[]: corners, then normals at the corners; w: their texture coordinates, u of the corners, v of the
// normals.
#define TRIANGLE_SIZE 6u

// materials[]: see material_of() in light.glsl. In the fourth, w: its pattern in texels[] (pattern.glsl) or NONE. Last
// its picture: the first of its texels in texels[] or NONE, its width and height, and how often it goes round.
#define MATERIAL_SIZE 6u

// A hit of a set in a plane is near enough, or plenty, if none can be nearer by more than these shares of the half
// width.
#define NEAR_ENOUGH_SHARE 0.25f
#define PLENTY_SHARE 1e-4f
// A ray's visits before it takes what is near enough.
#define PATIENCE 256u

struct Lamp {
    vec4 at;  // of a sun: the unit vector towards it; w: 1 for a sun
    vec4 rgb; // w: 1 if it throws no shadows
    vec4 a, b; // half axes of an area; a.w: 1 if it is round, b.w: 1 if it is an area
};

#define MOST_LAMPS 64u

struct Scene {
    vec4 right, up, direction; // of the camera; w: half width, half height, 1 if its rays are parallel
    vec4 lens;                 // radius, depth, the length of a pixel
    vec4 widths;               // least half width over the error, how far it reaches, the world's margin
    vec4 plane;       // of a set that lies in one (NearEnough): its normal (0: none), its height from the eye
    vec4 plane_parts; // the most half width; the reaches of widened parts and of terminals
    vec4 projection;           // pixels per tangent over the error, nearest distance, error in the world, culls
    vec4 edges;                // sine and cosine of half the angle of view, across and up
    vec4 sky_zenith, sky_horizon, sky_axis; // w: from, slope, 1 if the sky's light is shown
    vec4 light_up;             // of the sky's light; w: its kind
    vec4 light_zenith, light_horizon, light_below; // w: brightness
    vec4 clear_sun;                                // w: least height
    vec4 clear_zenith;                             // w: over which the brightness is divided
    vec4 perez[4];                                 // 15 numbers: five for each of Y, x, y
    vec4 picture_from_world[3];                    // columns; w of the first: width, of the second: height
    vec4 ground;                                   // height, 1 if there is one, transparent
    vec4 catcher;                                  // centre, radius; radius 0: none
    vec4 haze;     // distance (0: none), base, height (0: even all over), the sun's share
    vec4 haze_rgb; //
    vec4 ambient;  // light; w: exposure
    vec4 limits;   // farthest, least weight, noise in 255ths, most surfaces of a path
    uvec4 counts;  // lamps, root's box, root's steps, bounces
    uvec4 visits;  // most of a ray, more, ground's material, catcher's material
    uvec4 looks;    // 1 for a soft film; 2 rounds, for ends_loops_early()
    uvec4 tables; // the pixel filter's in texels[]; 1 if some texel of a surface is clear; patterns' waves in texels[]
    vec4 eye;     // in the world of the model
    Lamp lamps[MOST_LAMPS + 1u]; // after the last the sun that haze shows in shafts
};

// Counts of steps, in thousands, that tell what went wrong.
#define STEPS_LOST 1e30f
#define STEPS_ENDED 1e37f

// Entries of the pixel filter's table, less one.
#define FILTER_STEPS 256

// Waves of solid patterns (compiler/graph/pattern.h): so many a level.
#define PATTERN_LEVELS 16
#define PATTERN_WAVES 17u

// Kinds of the sky's light.
#define LIGHT_NONE 0
#define LIGHT_GRADIENT 1
#define LIGHT_CLEAR 2
#define LIGHT_PICTURE 3
