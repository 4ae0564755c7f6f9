use etalon::math::*;
use etalon::raycast::specimen::*;
use etalon::raycast::*;
use etalon::scene::*;

#[test]
fn builtin_brute() {
    let mut n = Numbers::new(1);
    for k in 0..20 {
        let stage = Stage::from_polygons(&clutter(DVec3::new(3.0, 4.0, 2.5), 20 + k, &mut n));
        let kernel = BuiltinKernel::new(&stage);
        for f in 0..stage.facets.len() as u32 {
            let rays = rays_from(&stage, f, 100, &mut n);
            let (mut a, mut b) = (vec![0; 100], vec![0; 100]);
            kernel.intersect(&rays, &mut a);
            kernel.intersect_all(&rays, &mut b);
            assert_eq!(a, b);
        }
    }
}
#[test]
fn speed() {
    for (name, polys) in [
        ("box", tessellated(&box_polygons(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), true), 21)),
        ("ball", bumpy_ball(84, true)),
        ("clutter", clutter(DVec3::new(3.0, 4.0, 2.5), 100, &mut Numbers::new(3))),
    ] {
        let t0 = std::time::Instant::now();
        let stage = Stage::from_polygons(&polys);
        let kernel = BuiltinKernel::new(&stage);
        println!("{name} {} build {:?}", stage.facets.len(), t0.elapsed());
        let mut n = Numbers::new(1);
        let m = stage.facets.len();
        let batches: Vec<_> = (0..1000).map(|k| rays_from(&stage, (k * 7919 % m) as u32, 512, &mut n)).collect();
        let mut out = vec![0; 512];
        let t0 = std::time::Instant::now();
        let mut esc = 0;
        for b in &batches {
            kernel.intersect(b, &mut out);
            esc += out.iter().filter(|f| **f == NO_FACET).count();
        }
        println!("{name} {:.2} Mrays/s escapes {esc}", 0.512 / t0.elapsed().as_secs_f64());
    }
}
#[test]
fn embree_agrees() {
    for (name, polys) in [
        ("box", tessellated(&box_polygons(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.5), true), 21)),
        ("ball", bumpy_ball(84, true)),
        ("clutter", clutter(DVec3::new(3.0, 4.0, 2.5), 100, &mut Numbers::new(3))),
        (
            "rot",
            rotated(
                &clutter(DVec3::new(3.0, 4.0, 2.5), 100, &mut Numbers::new(3)),
                DVec3::new(1., 2., 3.).normalize(),
                1.0,
            ),
        ),
    ] {
        let stage = Stage::from_polygons(&polys);
        let t0 = std::time::Instant::now();
        let k = open_kernels(KernelKind::Embree, &stage).unwrap();
        println!("{name} {} build {:?} {:?}", stage.facets.len(), t0.elapsed(), k.kernel.info());
        let mut n = Numbers::new(1);
        let m = stage.facets.len();
        let batches: Vec<_> = (0..1000).map(|k| rays_from(&stage, (k * 7919 % m) as u32, 512, &mut n)).collect();
        let (mut a, mut b) = (vec![0; 512], vec![0; 512]);
        let (mut esc, mut diff) = (0, 0);
        let mut t = std::time::Duration::ZERO;
        for r in &batches {
            let t0 = std::time::Instant::now();
            k.kernel.intersect(r, &mut a);
            t += t0.elapsed();
            k.exact.intersect(r, &mut b);
            esc += a.iter().filter(|f| **f == NO_FACET).count();
            diff += a.iter().zip(&b).filter(|(a, b)| a != b).count();
        }
        println!("{name} {:.2} Mrays/s escapes {esc} differences {diff}", 0.512 / t.as_secs_f64());
    }
}
