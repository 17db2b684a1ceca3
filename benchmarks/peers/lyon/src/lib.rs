//! lyon_geom behind a C interface, for the benchmarks.

use lyon_geom::euclid::point2 as point;
use lyon_geom::{CubicBezierSegment, QuadraticBezierSegment};

unsafe fn cubic(c: *const f64) -> CubicBezierSegment<f64> {
    let c = std::slice::from_raw_parts(c, 8);
    CubicBezierSegment {
        from: point(c[0], c[1]),
        ctrl1: point(c[2], c[3]),
        ctrl2: point(c[4], c[5]),
        to: point(c[6], c[7]),
    }
}

unsafe fn quadratic(c: *const f64) -> QuadraticBezierSegment<f64> {
    let c = std::slice::from_raw_parts(c, 6);
    QuadraticBezierSegment {
        from: point(c[0], c[1]),
        ctrl: point(c[2], c[3]),
        to: point(c[4], c[5]),
    }
}

/// Writes up to 9 parameter pairs to `out` and returns how many.
fn store(found: lyon_geom::arrayvec::ArrayVec<(f64, f64), 9>, out: *mut f64) -> i32 {
    for (i, (s, t)) in found.iter().enumerate() {
        unsafe {
            *out.add(2 * i) = *s;
            *out.add(2 * i + 1) = *t;
        }
    }
    found.len() as i32
}

/// # Safety
/// `a` and `b` point to 8 numbers, `out` to room for 18. A panic returns -1.
#[no_mangle]
pub unsafe extern "C" fn peer_lyon_cubics(a: *const f64, b: *const f64, out: *mut f64) -> i32 {
    let (a, b) = (cubic(a), cubic(b));
    match std::panic::catch_unwind(|| a.cubic_intersections_t(&b)) {
        Ok(found) => store(found, out),
        Err(_) => -1,
    }
}

/// lyon has no routine of its own for two quadratic curves: the first is raised to degree 3.
///
/// # Safety
/// `a` and `b` point to 6 numbers, `out` to room for 18. A panic returns -1.
#[no_mangle]
pub unsafe extern "C" fn peer_lyon_quadratics(a: *const f64, b: *const f64, out: *mut f64) -> i32 {
    let (a, b) = (quadratic(a).to_cubic(), quadratic(b));
    match std::panic::catch_unwind(|| a.quadratic_intersections_t(&b)) {
        Ok(found) => store(found, out),
        Err(_) => -1,
    }
}

/// # Safety
/// `c` points to 8 numbers, `s` to `count`, `out` to room for 2 `count`.
#[no_mangle]
pub unsafe extern "C" fn peer_lyon_sample(c: *const f64, s: *const f64, count: usize, out: *mut f64) {
    let c = cubic(c);
    for i in 0..count {
        let p = c.sample(*s.add(i));
        *out.add(2 * i) = p.x;
        *out.add(2 * i + 1) = p.y;
    }
}
