// What the host asks of the kernel of points.

struct Job {
    uvec4 window; // width, height; first row and number of rows that are counted
    uvec4 work;   // walkers; points of each; of them those with one more; what to do
    uvec4 start;  // first slot and slots of the table of beginnings; moves to settle; index of the last colour
    uvec4 more;   // seed; cells; levels of a colour
    uvec4 orbit;  // its last move; index of the colour behind the core; first form; OrbitModel::restart, a float
    uvec4 sources; // first slot and slots of their table
    vec4 origin;  // where walkers begin
};

// What to do: bits.
#define JOB_BEGINS 1u // walkers are new
#define JOB_SWEEPS 2u // the cells, in place of points
#define JOB_PACKS 4u  // points go to cells of their own first, three channels and the number by one addition

#define GROUP_SIZE 128u
#define CELLS_OF_THREAD 128u
