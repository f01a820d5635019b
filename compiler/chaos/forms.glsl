// Forms of surfaces in a FlatGame, for it and for the kernel of points.
#define FORM_GROUP 0u // several forms, of which a table chooses
#define FORM_TRIANGLE 1u // <0, 0, 0>, <1, 0, 0>, <0, 1, 0>
#define FORM_SPHERE 2u
#define FORM_CUBE 3u
#define FORM_TAPERED 4u
#define FORM_TORUS 5u
