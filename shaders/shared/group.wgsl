// Patches, or super-patches with the patches in them. Twin of src/layout.rs, Group.
struct Group {
    bound: DoubleCone,
    first: u32,
    count: u32,
    part: u32,
    // 1, or 0 for a further piece of a patch and for edges that no patch holds: those do not count.
    weight: u32,
}
