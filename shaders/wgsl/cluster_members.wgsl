#define_import_path welkin::cluster_members
// What a cluster holds, one after the other:
//
//   var found = volumes_of(cluster);
//   for (var index = next_member(&found); index != NONE; index = next_member(&found)) { ... }
//
// Definitions: as welkin::cluster; LAMP_FROXELS (light of what is far from a place comes from froxels).

#import welkin::cluster::{LIGHT_WORDS, VOLUME_WORDS}
#import welkin::volume_field::FOG_COUNT

@group(1) @binding(46) var<storage, read> cluster_masks: array<u32>;

const NONE: u32 = 0xffffffffu;

struct Members {
    // Bits left of the word that is looked at, and the number of its first.
    bits: u32,
    base: u32,
    // The next word, and where they end.
    word: u32,
    end: u32,
}

fn next_member(members: ptr<function, Members>) -> u32 {
    while (*members).bits == 0u {
        if (*members).word >= (*members).end {
            return NONE;
        }
        (*members).bits = cluster_masks[(*members).word];
        (*members).word += 1u;
        (*members).base += 32u;
    }
    let bit = firstTrailingBit((*members).bits);
    (*members).bits &= (*members).bits - 1u;
    return (*members).base + bit;
}

// Numbers count from `first`, whose word is the cluster's first one but for `words`.
fn members(first: u32, word: u32, words: u32) -> Members {
    return Members(0u, first - 32u, word, word + words);
}

// Local volumes.
fn volumes_of(cluster: u32) -> Members {
    return members(FOG_COUNT, cluster, VOLUME_WORDS);
}

// Local lights that reach the cluster.
fn lamps_of(cluster: u32) -> Members {
    return members(0u, cluster + VOLUME_WORDS, LIGHT_WORDS);
}

// Those of them whose light no froxel holds.
fn near_lamps_of(cluster: u32) -> Members {
#ifdef LAMP_FROXELS
    return members(0u, cluster + VOLUME_WORDS + LIGHT_WORDS, LIGHT_WORDS);
#else
    return lamps_of(cluster);
#endif
}
