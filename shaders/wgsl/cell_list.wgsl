#define_import_path welkin::cell_list
// A list of cells of pixels that are evaluated one by one: workgroups along three axes, for an indirect dispatch, the number of cells,
// and then each.

const CELL_TOTAL: u32 = 3u;
const LIST_HEADER: u32 = 4u;
// Workgroups that the least of devices takes along an axis; they go on to the cells beyond.
const MOST_GROUPS: u32 = 32768u;

fn entry_of_cell(cell: vec2<u32>) -> u32 {
    return cell.x | (cell.y << 16u);
}

fn cell_of_entry(entry: u32) -> vec2<u32> {
    return vec2<u32>(entry & 0xffffu, entry >> 16u);
}
