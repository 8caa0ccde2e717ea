#define_import_path welkin::local_lists
// Lists of volumes: those that may stand between a volume, or the reach of a local light, and the light.

@group(1) @binding(44) var<storage, read> local_lists: array<u32>;
