//! Kernels against their twins, and both against double precision.

mod common;

use chordal_gpu::{
    DeviceChoice, Edit, Gpu, GpuError, KernelRunner, OnDevice, Real, Request, Resource, Samples, Search,
    SurfaceSet, Variant, Wanted, evaluate_twin, sorted_by_span,
};
use chordal_nurbs::{Curve, DVec2, DVec3, Frame, NurbsCurve3, NurbsSurface, Range, math};
use common::{Random, gpu, no_gpu};

fn set_of<R: Real>(surfaces: &[NurbsSurface]) -> SurfaceSet<R> {
    let mut set = SurfaceSet::with_bezier();
    surfaces.iter().for_each(|s| {
        set.push_surface(s);
    });
    set
}

fn grids<R: Real>(set: &SurfaceSet<R>, random: &mut Random) -> Vec<Request> {
    (0..set.len()).map(|i| Request::even_grid(set, i, 2 + random.below(12), 2 + random.below(12))).collect()
}

/// All modes: results of the device, of the twin.
fn both<R: Real>(
    set: &SurfaceSet<R>,
    samples: &Samples<R>,
    mode: (Variant, Wanted, Search),
) -> (Vec<R>, Vec<R>) {
    let (variant, wanted, search) = mode;
    let evaluator = KernelRunner::new(gpu(), variant, search).expect("the kernels compile");
    let found = evaluator.evaluate(gpu(), set, samples, wanted).expect("the device evaluates");
    (found.values, evaluate_twin(set, samples, variant, wanted, search).expect("the twin fits"))
}

fn modes() -> Vec<(Variant, Wanted, Search)> {
    let mut modes = Vec::new();
    for variant in Variant::ALL {
        for wanted in [Wanted::Points, Wanted::Normals, Wanted::First, Wanted::Second] {
            modes.push((variant, wanted, Search::Host));
        }
    }
    for variant in [Variant::Indexed, Variant::Direct, Variant::Bernstein] {
        modes.push((variant, Wanted::First, Search::Device));
    }
    modes
}

#[test]
fn double_precision_equals_the_twins_to_the_bit() {
    if no_gpu() {
        return;
    }
    if !gpu().has_f64() {
        eprintln!("NOT TESTED: {} has no double precision in shaders", gpu().name());
        return;
    }
    let mut random = Random(1);
    let set = set_of::<f64>(&common::zoo(&mut random));
    let samples = Samples::new(&set, &grids(&set, &mut random)).unwrap();
    for mode in modes() {
        let (found, expected) = both(&set, &samples, mode);
        let differ = found.iter().zip(&expected).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
        assert_eq!(differ, 0, "{mode:?}: {differ} of {} numbers differ", found.len());
    }
}

/// Points of kernels and twins in single precision lie within the stated bound of the exact ones, on surfaces
/// of every degree, thousands of times their size away from the origin, with short and long spans.
#[test]
fn single_precision_keeps_its_bound() {
    if no_gpu() {
        return;
    }
    let mut random = Random(2);
    let surfaces = common::zoo(&mut random);
    let set = set_of::<f32>(&surfaces);
    let requests = grids(&set, &mut random);
    let samples = Samples::new(&set, &requests).unwrap();
    for variant in Variant::ALL {
        let (found, twin) = both(&set, &samples, (variant, Wanted::Points, Search::Host));
        let mut worst = (0.0_f64, 0);
        for (index, (surface, request)) in surfaces.iter().zip(&requests).enumerate() {
            let Request::Grid { us, vs, .. } = request else { unreachable!() };
            let entry = &set.entries()[index];
            let bound = entry.point_bound::<f32>();
            let uvs = us.iter().flat_map(|&u| vs.iter().map(move |&v| DVec2::new(u, v)));
            for (k, uv) in samples.range(index).zip(uvs) {
                let at = |values: &[f32]| {
                    let local = DVec3::from_slice(&[0, 1, 2].map(|c| f64::from(values[3 * k + c])));
                    entry.frame.middle + local * entry.frame.size
                };
                let exact = surface.point(uv);
                for (who, p) in [("device", at(&found)), ("twin", at(&twin))] {
                    let ratio = p.distance(exact) / bound;
                    assert!(
                        ratio <= 1.0,
                        "{variant:?} {who}, degree {:?}: {ratio} of the bound",
                        entry.degree
                    );
                    if ratio > worst.0 {
                        worst = (ratio, index);
                    }
                }
            }
        }
        println!(
            "{}: at most {:.3} of the bound, degree {:?}",
            variant.name(),
            worst.0,
            set.entries()[worst.1].degree
        );
    }
}

/// The crate `nurbs` has passes of its own, over tables of the file's knots: twins of the paper's layouts
/// agree with them.
#[test]
fn twins_agree_with_the_passes_of_nurbs() {
    let mut random = Random(10);
    let surfaces = common::zoo(&mut random);
    let set = set_of::<f64>(&surfaces);
    let requests = grids(&set, &mut random);
    let samples = Samples::new(&set, &requests).unwrap();
    let mut compared = 0;
    for variant in Variant::ALL.into_iter().filter(|v| v.has_passes()) {
        let found = evaluate_twin(&set, &samples, variant, Wanted::Points, Search::Host).unwrap();
        for (index, (surface, request)) in surfaces.iter().zip(&requests).enumerate() {
            let Request::Grid { us, vs, .. } = request else { unreachable!() };
            let entry = &set.entries()[index];
            let theirs = surface.points_by_passes(us, vs);
            assert_eq!(theirs.len(), samples.range(index).len());
            for (k, theirs) in samples.range(index).zip(theirs) {
                let p = entry.frame.middle + DVec3::from_slice(&found[3 * k..3 * k + 3]) * entry.frame.size;
                let ratio = p.distance(theirs) / entry.point_bound::<f64>();
                assert!(ratio <= 1.0, "{variant:?} degree {:?}: {ratio} of the bound", entry.degree);
                compared += 1;
            }
        }
    }
    assert!(compared > 3 * 100 * 4, "{compared}");
}

/// Derivatives and normals in double precision are those of the crate `nurbs`.
#[test]
fn derivatives_are_those_of_nurbs() {
    let mut random = Random(3);
    let surfaces: Vec<_> =
        common::zoo(&mut random).into_iter().filter(|s| s.degree().iter().all(|&d| d <= 20)).collect();
    let set = set_of::<f64>(&surfaces);
    let requests = grids(&set, &mut random);
    let samples = Samples::new(&set, &requests).unwrap();
    for variant in Variant::ALL {
        let found = evaluate_twin(&set, &samples, variant, Wanted::Second, Search::Host).unwrap();
        for (index, (surface, request)) in surfaces.iter().zip(&requests).enumerate() {
            let Request::Grid { us, vs, .. } = request else { unreachable!() };
            let size = set.entries()[index].frame.size;
            // Rounding of a control point weighs by the degree over the length of the shortest span, once per
            // order.
            let shortest = |breaks: &[f64]| breaks.windows(2).map(|w| w[1] - w[0]).fold(1.0, f64::min);
            let span = shortest(&surface.breaks_u()).min(shortest(&surface.breaks_v()));
            let steep = surface.degree().into_iter().max().unwrap() as f64 / span;
            let uvs = us.iter().flat_map(|&u| vs.iter().map(move |&v| DVec2::new(u, v)));
            for (k, uv) in samples.range(index).zip(uvs) {
                let jet = surface.jet(uv);
                let value = |slot: usize| DVec3::from_slice(&found[21 * k + 3 * slot..]);
                let expected = [jet.du, jet.dv, jet.duu, jet.duv, jet.dvv];
                for (slot, expected) in [1, 2, 4, 5, 6].into_iter().zip(expected) {
                    let order = if slot < 3 { 1 } else { 2 };
                    let scale = 1e-10 * expected.length() + 1e-12 * size * math::powi(steep, order);
                    let error = (value(slot) * size).distance(expected);
                    assert!(error <= scale, "{variant:?} {:?} {slot}: {error}", surface.degree());
                }
                let n = jet.du.cross(jet.dv).normalize_or_zero();
                assert!(value(3).distance(n) < 1e-6, "{variant:?}: normal {} {n}", value(3));
            }
        }
    }
}

/// Scattered points, sorted or not, are the points of grids; the two orders agree to the bit.
#[test]
fn lists_of_points_agree_with_grids() {
    if no_gpu() {
        return;
    }
    let mut random = Random(4);
    let surface = common::surface(&mut random, [3, 4], [5, 7]);
    let set = set_of::<f32>(std::slice::from_ref(&surface));
    let domain = surface.domain();
    let uvs: Vec<DVec2> =
        (0..1000).map(|_| domain.min + domain.size() * DVec2::new(random.next(), random.next())).collect();
    let (sorted, order) = sorted_by_span(&set, 0, &uvs);
    for variant in Variant::ALL {
        let run = |uvs: &[DVec2]| {
            let samples = Samples::new(&set, &[Request::Points { surface: 0, uvs: uvs.to_vec() }]).unwrap();
            both(&set, &samples, (variant, Wanted::Points, Search::Host)).0
        };
        let (plain, by_span) = (run(&uvs), run(&sorted));
        for (at, &from) in order.iter().enumerate() {
            assert_eq!(plain[3 * from..3 * from + 3], by_span[3 * at..3 * at + 3], "{variant:?}");
        }
        let entry = &set.entries()[0];
        for (k, &uv) in uvs.iter().enumerate() {
            let local = DVec3::from_slice(&[0, 1, 2].map(|c| f64::from(plain[3 * k + c])));
            let p = entry.frame.middle + local * entry.frame.size;
            assert!(p.distance(surface.point(uv)) <= entry.point_bound::<f32>());
        }
    }
}

/// A circle is a circle: curves go the same way as surfaces.
#[test]
fn curves_are_surfaces_without_a_second_degree() {
    if no_gpu() {
        return;
    }
    let frame = Frame::new(DVec3::new(7.0, 8.0, 9.0), DVec3::Z, DVec3::X);
    let circle = Curve::Circle { frame, radius: 2.0 }.to_nurbs(Range::new(0.0, 6.0)).unwrap();
    let wild = NurbsCurve3::new(
        3,
        vec![0.0, 0.0, 0.0, 0.0, 0.1, 0.1, 0.5, 1.0, 1.0, 1.0, 1.0],
        (0..7).map(|i| DVec3::new(f64::from(i), f64::from(i * i % 5), 1.0)).collect(),
        None,
    )
    .unwrap();
    let mut set = SurfaceSet::<f32>::with_bezier();
    let curves = [circle, wild];
    curves.iter().for_each(|c| {
        set.push_curve(c);
    });
    let ts = |c: &NurbsCurve3| (0..100).map(|k| c.domain().end * f64::from(k) / 99.0).collect::<Vec<_>>();
    let requests: Vec<_> = curves.iter().enumerate().map(|(i, c)| Request::curve(i, ts(c))).collect();
    let samples = Samples::new(&set, &requests).unwrap();
    for variant in Variant::ALL {
        let (found, _) = both(&set, &samples, (variant, Wanted::Points, Search::Host));
        for (i, curve) in curves.iter().enumerate() {
            let entry = &set.entries()[i];
            for (k, t) in samples.range(i).zip(ts(curve)) {
                let local = DVec3::from_slice(&[0, 1, 2].map(|c| f64::from(found[3 * k + c])));
                let p = entry.frame.middle + local * entry.frame.size;
                assert!(p.distance(curve.point(t)) <= entry.point_bound::<f32>(), "{variant:?} {i} {t}");
            }
        }
    }
}

/// After an edit of one surface only its bytes travel, and the next run gives the points of the edited set.
#[test]
fn an_edit_uploads_only_what_changed() {
    if no_gpu() {
        return;
    }
    let mut random = Random(5);
    let mut surfaces: Vec<_> = (0..50).map(|_| common::surface(&mut random, [3, 3], [4, 4])).collect();
    for variant in [Variant::Indexed, Variant::Direct, Variant::Bernstein] {
        let mut set = set_of::<f32>(&surfaces);
        let samples = Samples::new(&set, &grids(&set, &mut random)).unwrap();
        let on_device = OnDevice::upload(gpu(), &set).unwrap();
        let evaluator = KernelRunner::new(gpu(), variant, Search::Host).unwrap();
        let evaluation = evaluator.prepare(gpu(), &on_device, &set, &samples, Wanted::First).unwrap();
        let s = &surfaces[17];
        let moved = s.points().iter().map(|p| *p * 1.5 + DVec3::X * random.next()).collect();
        let knots_u = s.knots_u().iter().map(|k| 2.0 * k + 1.0).collect();
        let weights = s.weights().map(<[f64]>::to_vec);
        surfaces[17] = NurbsSurface::new([3, 3], knots_u, s.knots_v().to_vec(), moved, weights).unwrap();
        let edit = set.replace(17, &surfaces[17]).unwrap();
        assert_eq!(edit, Edit { points: true, knots: true });
        let sent = on_device.update(gpu(), &set, 17, edit).unwrap();
        assert!(sent * 25 < on_device.bytes(), "{sent} of {}", on_device.bytes());
        // Nothing, control points alone, knots alone.
        let s = &surfaces[17];
        let other = |points: Vec<DVec3>, stretch: f64| {
            let knots = s.knots_v().iter().map(|k| stretch * k).collect();
            let weights = s.weights().map(<[f64]>::to_vec);
            NurbsSurface::new([3, 3], s.knots_u().to_vec(), knots, points, weights).unwrap()
        };
        let mut part = |surface: &NurbsSurface| {
            let edit = set.replace(17, surface).unwrap();
            (edit, on_device.update(gpu(), &set, 17, edit).unwrap())
        };
        let raised = other(s.points().iter().map(|p| *p + DVec3::Z * p.x).collect(), 1.0);
        assert_eq!(part(s), (Edit { points: false, knots: false }, 0));
        let (edit, of_points) = part(&raised);
        assert!(edit == Edit { points: true, knots: false } && of_points < sent, "{of_points} of {sent}");
        let back = part(s);
        assert_eq!(back, (edit, of_points));
        let (edit, of_knots) = part(&other(s.points().to_vec(), 3.0));
        assert!(edit == Edit { points: false, knots: true } && of_knots < sent, "{of_knots} of {sent}");
        evaluator.run(gpu(), &evaluation).unwrap();
        let found = evaluation.read(gpu()).unwrap().values;
        let fresh = evaluator.evaluate(gpu(), &set, &samples, Wanted::First).unwrap().values;
        assert_eq!(found, fresh, "{variant:?}");
    }
}

#[test]
fn what_does_not_fit_is_an_error() {
    let mut random = Random(6);
    let [a, b] = [[2, 2], [3, 2]].map(|degree| common::surface(&mut random, degree, [2, 2]));
    let mut set = SurfaceSet::<f32>::new();
    set.push_surface(&a);
    assert_eq!(set.replace(0, &b), Err(GpuError::OtherShape { index: 0 }));
    assert_eq!(set.replace(3, &a), Err(GpuError::NoSuchSurface(3)));
    let request = Request::even_grid(&set, 0, 3, 3);
    let samples = Samples::new(&set, &[request]).unwrap();
    assert!(evaluate_twin(&set, &samples, Variant::Bernstein, Wanted::Points, Search::Host).is_err());
    assert!(evaluate_twin(&set, &samples, Variant::Packed, Wanted::Points, Search::Device).is_err());
    let elsewhere = Request::Points { surface: 1, uvs: vec![DVec2::ZERO] };
    assert_eq!(Samples::new(&set, &[elsewhere]).err(), Some(GpuError::NoSuchSurface(1)));
}

/// More points than one binding holds come in several buffers, and are the same points.
#[test]
fn large_grids_are_split_between_bindings() {
    if no_gpu() {
        return;
    }
    let mut random = Random(7);
    let surface = common::surface(&mut random, [1, 2], [2, 2]);
    let mut set = SurfaceSet::<f32>::new();
    set.push_surface(&surface);
    let width = (gpu().binding_limit() / 12).min(12 << 20) as usize / 1024 + 513;
    let request = Request::even_grid(&set, 0, width, 1024);
    let samples = Samples::new(&set, &[request]).unwrap();
    let evaluator = KernelRunner::new(gpu(), Variant::Direct, Search::Host).unwrap();
    let on_device = OnDevice::upload(gpu(), &set).unwrap();
    let evaluation = evaluator.prepare(gpu(), &on_device, &set, &samples, Wanted::Points).unwrap();
    evaluator.run(gpu(), &evaluation).unwrap();
    let found = evaluation.read(gpu()).unwrap().values;
    let buffers = evaluation.buffers().count();
    assert_eq!(found.len(), 3 * width * 1024);
    if gpu().binding_limit() <= 128 << 20 {
        assert!(buffers > 1);
    }
    let (entry, domain) = (&set.entries()[0], surface.domain());
    for k in (0..width * 1024).step_by(9973) {
        let at = DVec2::new((k / 1024) as f64 / (width - 1) as f64, (k % 1024) as f64 / 1023.0);
        let local = DVec3::from_slice(&[0, 1, 2].map(|c| f64::from(found[3 * k + c])));
        let p = entry.frame.middle + local * entry.frame.size;
        let exact = surface.point(domain.min + domain.size() * at);
        assert!(p.distance(exact) <= entry.point_bound::<f32>(), "{k}");
    }
}

/// A device that binds little at once: points are split, what cannot be is refused by name, nothing is cut
/// off.
#[test]
fn what_exceeds_a_binding_is_split_or_refused() {
    if no_gpu() {
        return;
    }
    let limit = 8 << 20;
    let small = Gpu::open_within(DeviceChoice::Best, limit).expect("a device");
    assert_eq!(small.binding_limit(), limit);
    let mut random = Random(8);
    let surface = common::surface(&mut random, [2, 3], [3, 2]);
    let set = set_of::<f32>(std::slice::from_ref(&surface));
    let grid = |n: usize| Samples::new(&set, &[Request::even_grid(&set, 0, n, n)]).unwrap();
    let evaluator = |variant| KernelRunner::<f32>::new(&small, variant, Search::Host).unwrap();
    // 12 MB of points.
    let samples = grid(1000);
    let direct = evaluator(Variant::Direct);
    let on_device = OnDevice::upload(&small, &set).unwrap();
    let evaluation = direct.prepare(&small, &on_device, &set, &samples, Wanted::Points).unwrap();
    assert!(evaluation.buffers().count() > 1);
    direct.run(&small, &evaluation).unwrap();
    let found = evaluation.read(&small).unwrap().values;
    let whole = KernelRunner::<f32>::new(gpu(), Variant::Direct, Search::Host)
        .unwrap()
        .evaluate(gpu(), &set, &samples, Wanted::Points)
        .unwrap();
    assert_eq!(found, whole.values);
    // 84 bytes a point: no grid is so large that its heads do not fit.
    let second = direct.evaluate(&small, &set, &samples, Wanted::Second).unwrap();
    assert_eq!(second.values.len(), 21 * 1_000_000);
    // A list whose basis functions take 34 MB, by all variants.
    let domain = surface.domain();
    let uvs = (0..300_000).map(|_| domain.min + domain.size() * DVec2::new(random.next(), random.next()));
    let list = Samples::new(&set, &[Request::Points { surface: 0, uvs: uvs.collect() }]).unwrap();
    for variant in Variant::ALL {
        let here = evaluator(variant).evaluate(&small, &set, &list, Wanted::Points).unwrap();
        let there = KernelRunner::<f32>::new(gpu(), variant, Search::Host).unwrap();
        let there = there.evaluate(gpu(), &set, &list, Wanted::Points).unwrap();
        assert!(here.values == there.values, "{variant:?}");
    }
    // One head of the highest degree has more basis functions than fit.
    let steep = set_of::<f32>(&[common::surface(&mut random, [100, 1], [1, 1])]);
    let many = Samples::new(&steep, &[Request::even_grid(&steep, 0, 40_000, 2)]).unwrap();
    let refused = evaluator(Variant::Packed).evaluate(&small, &steep, &many, Wanted::Points).err();
    let Some(GpuError::TooLarge { what, bytes, limit: said, .. }) = &refused else { panic!("{refused:?}") };
    assert!(*bytes > limit && *said == limit, "{what}: {bytes} of {said}");
    // Control points of a set that is too large.
    let mut large = SurfaceSet::<f32>::new();
    let many = common::surface(&mut random, [3, 3], [200, 200]);
    for _ in 0..20 {
        large.push_surface(&many);
    }
    let refused = OnDevice::upload(&small, &large).err();
    assert!(matches!(&refused, Some(GpuError::TooLarge { what: Resource::ControlPoints, .. })));
}

/// A device that goes away is an error at the next call, whatever that is.
#[test]
fn a_lost_device_is_an_error() {
    if no_gpu() {
        return;
    }
    let mut random = Random(9);
    let set = set_of::<f32>(&[common::surface(&mut random, [3, 3], [2, 2])]);
    let samples = Samples::new(&set, &grids(&set, &mut random)).unwrap();
    let doomed = Gpu::open(DeviceChoice::Best).expect("a device");
    let evaluator = KernelRunner::<f32>::new(&doomed, Variant::Bernstein, Search::Host).unwrap();
    let on_device = OnDevice::upload(&doomed, &set).unwrap();
    let evaluation = evaluator.prepare(&doomed, &on_device, &set, &samples, Wanted::Points).unwrap();
    evaluator.run(&doomed, &evaluation).unwrap();
    doomed.device.destroy();
    let lost = |what: &str, result: Option<GpuError>| {
        assert!(matches!(result, Some(GpuError::Lost(_))), "{what}: {result:?}");
    };
    lost("reading", evaluation.read(&doomed).err());
    lost("running", evaluator.run(&doomed, &evaluation).err());
    lost("an edit", on_device.update(&doomed, &set, 0, Edit { points: true, knots: true }).err());
    lost("uploading", OnDevice::upload(&doomed, &set).err());
    lost("all", evaluator.evaluate(&doomed, &set, &samples, Wanted::Points).err());
    lost("compiling", KernelRunner::<f32>::new(&doomed, Variant::Direct, Search::Host).err());
    lost("waiting", doomed.wait().err());
}
