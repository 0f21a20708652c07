//! Sources are valid, and what both sides use is the same on both.

use std::mem::offset_of;

use drypoint_bounds::{DoubleCone, MIN_CLEARANCE};
use drypoint_shaders::{
    Arguments, BRUTE_FORCE, BendingFace, CONTOUR, CarrierTransform, Counters, Culling, DEPTH,
    DrawCounters, EdgeEnds, EdgePlanes, Emitted, Group, INK, LINES, LooseEdge, MeshShape,
    MorphOffset, PATCHES, POSITIONS, Part, PartFace, PlacedSegment, RIG_EDGES, RIG_FACES,
    RIG_VERTICES, ROW, Raster, RigCounts, SEGMENTS_PER_WORKGROUP, SUPER_PATCHES, Segment, Stroke,
    TALLY, THIN_LINES, Totals, Transform, VertexInfluence, WIDTHS, Work, mesh_source, prelude,
};
use naga::valid::{Capabilities, ValidationFlags, Validator};

fn parse(source: &str) -> naga::Module {
    naga::front::wgsl::parse_str(source)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)))
}

fn validate(source: &str, capabilities: Capabilities) -> naga::Module {
    let module = parse(source);
    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
    use naga::valid::ShaderStages;
    validator.subgroup_stages(ShaderStages::TASK | ShaderStages::MESH);
    validator.subgroup_operations(naga::valid::SubgroupOperationSet::all());
    let result = validator.validate(&module);
    result.unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)));
    module
}

/// Entry points of what runs anywhere.
fn plain() -> Vec<String> {
    let widths = WIDTHS.into_iter();
    let extraction = widths.flat_map(|width| {
        [BRUTE_FORCE, PATCHES, SUPER_PATCHES, RIG_VERTICES, RIG_FACES, RIG_EDGES]
            .map(|source| prelude(width) + source)
    });
    extraction
        .chain([CONTOUR, TALLY, POSITIONS, DEPTH, LINES, THIN_LINES, INK].map(str::to_owned))
        .collect()
}

#[test]
fn sources_are_valid_without_optional_features() {
    for source in plain() {
        validate(&source, Capabilities::empty());
    }
}

/// Every source for mesh shaders, complete.
fn meshes() -> impl Iterator<Item = String> {
    let cullings = [Culling::Nothing, Culling::Patches, Culling::SuperPatches].into_iter();
    let kinds = cullings.flat_map(|c| [Emitted::Lines, Emitted::Strokes].map(|e| (c, e)));
    kinds.flat_map(|(culling, emitted)| {
        [[32, 32, 32], [64, 32, 64], [128, 16, 16]].map(
            |[task_width, mesh_width, edges_per_workgroup]| {
                let records = task_width == 64;
                let shape = MeshShape { task_width, mesh_width, edges_per_workgroup, records };
                shape.prelude(culling) + mesh_source(culling, emitted)
            },
        )
    })
}

#[test]
fn mesh_shaders_need_nothing_but_subgroups() {
    for source in meshes() {
        let module = validate(&source, Capabilities::MESH_SHADER | Capabilities::SUBGROUP);
        assert!(!asks_for_number_of_workgroups(&module), "a driver gives a wrong one");
    }
    let asking = |argument: &str| format!("{argument} @compute @workgroup_size(1) fn f(a: A) {{}}");
    let direct =
        "alias A = u32; @compute @workgroup_size(1) fn f(@builtin(num_workgroups) n: vec3u) {}";
    assert!(asks_for_number_of_workgroups(&parse(direct)));
    let member = asking("struct A { @builtin(num_workgroups) n: vec3u }");
    assert!(asks_for_number_of_workgroups(&parse(&member)));
    let other = asking("struct A { @builtin(workgroup_id) n: vec3u }");
    assert!(!asks_for_number_of_workgroups(&parse(&other)));
}

/// By an argument of an entry point, or by a member of one: NVIDIA's driver 580 gives task and mesh shaders a wrong one.
fn asks_for_number_of_workgroups(module: &naga::Module) -> bool {
    let asked = Some(naga::Binding::BuiltIn(naga::BuiltIn::NumWorkGroups));
    let arguments = module.entry_points.iter().flat_map(|entry| &entry.function.arguments);
    arguments.into_iter().any(|argument| match &module.types[argument.ty].inner {
        naga::TypeInner::Struct { members, .. } => {
            members.iter().any(|member| member.binding == asked)
        }
        _ => argument.binding == asked,
    })
}

/// Each pipeline stays within what plain WebGPU allows: eight storage buffers, and 16 KiB and 256 lanes
/// in a workgroup.
#[test]
fn pipelines_fit_the_limits_of_webgpu() {
    for source in plain() {
        let module = parse(&source);
        let variables = || module.global_variables.iter().map(|(_, variable)| variable);
        let is_storage = |space| matches!(space, naga::AddressSpace::Storage { .. });
        let storage = variables().filter(|variable| is_storage(variable.space)).count();
        assert!(storage <= 8, "{storage} storage buffers");
        let shared = variables().filter(|variable| variable.space == naga::AddressSpace::WorkGroup);
        let size =
            |variable: &naga::GlobalVariable| module.types[variable.ty].inner.size(module.to_ctx());
        let bytes: u32 = shared.map(size).sum();
        assert!(bytes <= 16_384, "{bytes} bytes of a workgroup");
        for entry in &module.entry_points {
            assert!(entry.workgroup_size.iter().product::<u32>() <= 256);
        }
    }
}

/// Offsets of the members of a struct, and its size.
fn layout(source: &str, name: &str) -> (Vec<(String, usize)>, usize) {
    let module = parse(source);
    let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name));
    let (_, ty) = found.unwrap_or_else(|| panic!("no struct {name}"));
    let naga::TypeInner::Struct { members, span } = &ty.inner else {
        panic!("{name} is no struct")
    };
    let offset = |member: &naga::StructMember| {
        (member.name.clone().expect("members have names"), member.offset as usize)
    };
    (members.iter().map(offset).collect(), *span as usize)
}

/// Compares a struct with its twin, member by member.
macro_rules! check {
    ($source:expr, $twin:ident { $($member:ident),+ $(,)? }) => {{
        let (members, size) = layout($source, stringify!($twin));
        let expected = [$((stringify!($member).to_owned(), offset_of!($twin, $member))),+];
        assert_eq!(members, expected, stringify!($twin));
        assert_eq!(size, size_of::<$twin>(), stringify!($twin));
    }};
}

#[test]
fn structs_have_the_same_layout_on_both_sides() {
    let patches = &(prelude(64) + PATCHES);
    check!(patches, DoubleCone { center, apex_distance, axis, tan_squared });
    check!(patches, EdgePlanes { left, right });
    check!(patches, EdgeEnds { from_vertex, to_vertex, edge, edge_class });
    check!(patches, Group { bound, first, count, part, weight });
    check!(patches, Segment { from_vertex, to_vertex, placement, edge });
    check!(
        patches,
        Work {
            first_item,
            item_count,
            items_per_workgroup,
            first_instance,
            instance_count,
            part_count,
            part,
            segment_capacity,
            first_placement,
            most_instances,
            row,
        }
    );
    check!(
        patches,
        Counters {
            first_segment,
            segments,
            edges_tested,
            patches_tested,
            patches_accepted,
            super_patches_tested,
            super_patches_accepted,
        }
    );
    check!(
        TALLY,
        Totals {
            segments,
            edges_tested,
            patches_tested,
            patches_accepted,
            super_patches_tested,
            super_patches_accepted,
        }
    );
    check!(TALLY, Arguments { line_list, quads, workgroups });
    check!(POSITIONS, PlacedSegment { from_position, placement, to_position, edge });
    check!(POSITIONS, Transform { x, y, z });
    check!(DEPTH, Part { part, part_count, first_placement });
    check!(LINES, Raster { size, depth_sign, depth_step });
}

#[test]
fn counters_of_draws_have_the_same_layout_on_both_sides() {
    let draws = &meshes().next().expect("there are mesh shaders");
    check!(
        draws,
        DrawCounters {
            segments,
            edges_tested,
            patches_tested,
            patches_accepted,
            super_patches_tested,
            super_patches_accepted,
            groups_accepted,
            mesh_workgroups,
            idle_mesh_workgroups,
        }
    );
}

#[test]
fn structs_of_rigs_have_the_same_layout_on_both_sides() {
    let [vertices, faces, edges] =
        [RIG_VERTICES, RIG_FACES, RIG_EDGES].map(|source| prelude(64) + source);
    check!(
        &vertices,
        VertexInfluence { position, weight, carrier, first_offset, offset_end, is_last }
    );
    check!(&vertices, MorphOffset { by, morph });
    check!(&faces, BendingFace { corners, carrier });
    check!(&faces, PartFace { plane, placements_before, class_placements, place, carrier });
    check!(
        &edges,
        LooseEdge { left_face, right_face, from_vertex, to_vertex, edge, is_right_turned }
    );
    check!(
        &edges,
        RigCounts {
            first_vertex,
            vertex_count,
            bending_count,
            face_count,
            carrier_count,
            morph_count,
        }
    );
}

/// WGSL names no padding at the end of a struct.
#[test]
fn a_stroke_has_the_same_layout_but_for_its_padding() {
    let (members, size) = layout(LINES, "Stroke");
    let expected = [
        ("scene_to_clip".to_owned(), offset_of!(Stroke, scene_to_clip)),
        ("color".to_owned(), offset_of!(Stroke, color)),
        ("half_width".to_owned(), offset_of!(Stroke, half_width)),
    ];
    assert_eq!(members, expected);
    assert_eq!(size, size_of::<Stroke>());
}

#[test]
fn a_carrier_has_the_same_layout_but_for_its_padding() {
    let (members, size) = layout(&(prelude(64) + RIG_VERTICES), "CarrierTransform");
    let expected = [
        ("x".to_owned(), offset_of!(CarrierTransform, x)),
        ("y".to_owned(), offset_of!(CarrierTransform, y)),
        ("z".to_owned(), offset_of!(CarrierTransform, z)),
        ("is_mirrored".to_owned(), offset_of!(CarrierTransform, is_mirrored)),
    ];
    assert_eq!(members, expected);
    assert_eq!(size, size_of::<CarrierTransform>());
}

#[test]
fn arguments_begin_where_they_are_said_to() {
    assert_eq!(Arguments::LINE_LIST, offset_of!(Arguments, line_list) as u64);
    assert_eq!(Arguments::QUADS, offset_of!(Arguments, quads) as u64);
    assert_eq!(Arguments::WORKGROUPS, offset_of!(Arguments, workgroups) as u64);
}

fn constant(source: &str, name: &str) -> naga::Literal {
    let module = parse(source);
    let found = module.constants.iter().find(|(_, c)| c.name.as_deref() == Some(name));
    let (_, constant) = found.unwrap_or_else(|| panic!("no constant {name}"));
    match module.global_expressions[constant.init] {
        naga::Expression::Literal(literal) => literal,
        ref other => panic!("{name} is {other:?}"),
    }
}

#[test]
fn constants_are_the_same_on_both_sides() {
    assert_eq!(constant(CONTOUR, "MIN_CLEARANCE"), naga::Literal::F32(MIN_CLEARANCE));
    assert_eq!(constant(TALLY, "ROW"), naga::Literal::U32(ROW));
    let lanes = naga::Literal::U32(SEGMENTS_PER_WORKGROUP);
    assert_eq!(constant(TALLY, "SEGMENTS_PER_WORKGROUP"), lanes);
    for width in WIDTHS {
        let source = prelude(width) + PATCHES;
        assert_eq!(constant(&source, "WIDTH"), naga::Literal::U32(width));
        assert_eq!(parse(&source).entry_points[0].workgroup_size, [width, 1, 1]);
    }
    assert_eq!(parse(POSITIONS).entry_points[0].workgroup_size, [SEGMENTS_PER_WORKGROUP, 1, 1]);
}

/// As `concat!` puts sources together, a struct that two of them need is in both: they must be one file.
#[test]
fn no_struct_is_written_twice() {
    let mut seen = std::collections::BTreeMap::new();
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    for folder in
        [folder.to_owned(), folder.join("shared"), folder.join("mesh"), folder.join("rig")]
    {
        for entry in std::fs::read_dir(folder).expect("it can be listed") {
            let path = entry.expect("it can be listed").path();
            if path.extension().is_none_or(|extension| extension != "wgsl") {
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("it can be read");
            for line in text.lines().filter(|line| line.starts_with("struct ")) {
                // One for each way of appending, and of emitting.
                if !["struct Lane ", "struct Output "].iter().any(|known| line.starts_with(known)) {
                    let first = seen.insert(line.to_owned(), path.clone());
                    assert_eq!(first, None, "{line} in {}", path.display());
                }
            }
        }
    }
    assert!(seen.len() > 8, "structs are found");
}
