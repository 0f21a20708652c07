use std::time::Instant;
use drypoint_fusion::{FusionParams, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, shapes};
use drypoint_wgpu::*;
#[test]
fn recording() {
    let mesh = shapes::icosphere(500);
    let adjacency = MeshAdjacency::new(&mesh);
    let set = fuse(&mesh, &adjacency, EdgeFilter::Convex, &FusionParams::FAST, &|_| std::ops::ControlFlow::Continue(())).unwrap();
    let gpu = Gpu::request().unwrap();
    let ex = Extractor::new(&gpu.device).unwrap();
    let model = Model::new(&ex, &[&set]).unwrap();
    let mut c = Contours::new(&ex, &model, Capacity { placements: 252, segments: 100_000 }).unwrap();
    let p: Vec<_> = (0..252).map(|i| Placement::at_origin(Viewpoint::at(glam::DVec3::new(i as f64, 5.0, 9.0)))).collect();
    let mut t: Vec<[f64; 5]> = vec![];
    for _ in 0..2000 {
        let s = Instant::now();
        let mut e = gpu.device.create_command_encoder(&Default::default());
        let a = s.elapsed().as_secs_f64();
        c.prepare(&mut e, &p, Method::Patches).unwrap();
        let b = s.elapsed().as_secs_f64();
        { let mut pass = e.begin_compute_pass(&Default::default()); ex.record(&mut pass, &c); }
        let d = s.elapsed().as_secs_f64();
        let cb = e.finish();
        let f = s.elapsed().as_secs_f64();
        gpu.queue.submit([cb]);
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        t.push([a, b - a, d - b, f - d, f - a]);
    }
    for i in 0..5 { let mut v: Vec<f64> = t.iter().map(|x| x[i]*1e6).collect(); v.sort_by(f64::total_cmp); println!("{i}: median {:.1} low {:.1} q3 {:.1}", v[1000], v[10], v[1500]); }
}
