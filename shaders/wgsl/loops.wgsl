#define_import_path welkin::loops
// Loops that are to stay loops.
//
// Compilers write out the body of a loop as often as it runs when they know how often that is. For a body of a few instructions
// that is right. For one of hundreds, or for a sum over all directions of a grid, it makes a shader that takes many times as long to
// compile and is no faster: docs/performance.md, "Starts".

#import welkin::atmosphere::atmosphere

// A loop's bound that no compiler foresees: no planet's radius is negative.
fn counted(count: u32) -> u32 {
    return count + u32(atmosphere.radius_m < 0.0);
}
