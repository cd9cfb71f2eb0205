//! What binds one core of the host, found by running it with the instructions that rows run with.
//!
//! On many cores the divider sits in one of the units that multiply and add, so neither peak alone is what a
//! mixture can reach; hence the third figure, of both at once in the proportion wanted.

use pulp::{Arch, Simd, WithSimd};
use std::hint::black_box;
use std::time::Instant;

/// Double-precision operations a second on one core.
#[derive(Clone, Copy, Debug)]
pub struct HostPeaks {
    /// Fused multiply-adds, with nothing else.
    pub multiply_adds: f64,
    /// Divisions, with nothing else.
    pub divisions: f64,
    /// Divisions with twelve fused multiply-adds beside each.
    pub both: f64,
}

/// Runs loops of independent chains and takes the best of several runs.
pub fn host_peaks() -> HostPeaks {
    let arch = Arch::new();
    let best = |run: &dyn Fn() -> f64| (0..9).map(|_| run()).fold(0.0, f64::max);
    HostPeaks {
        multiply_adds: CHAINS as f64 * best(&|| arch.dispatch(Chains::<1, 0>)),
        divisions: CHAINS as f64 * best(&|| arch.dispatch(Chains::<0, CHAINS>)),
        both: 5.0 * best(&|| arch.dispatch(Chains::<6, 5>)),
    }
}

/// Enough for the latency of a multiply-add on two units; few enough for sixteen registers.
const CHAINS: usize = 10;

/// A loop of `ROUNDS` multiply-adds on each of ten chains and a division on each of `DIVISIONS` chains.
struct Chains<const ROUNDS: usize, const DIVISIONS: usize>;

impl<const ROUNDS: usize, const DIVISIONS: usize> WithSimd for Chains<ROUNDS, DIVISIONS> {
    /// Numbers a second of each chain.
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        const STEPS: usize = 100_000;
        let factor = simd.splat_f64s(black_box(0.999_999));
        let mut sums = [simd.splat_f64s(black_box(1.0)); CHAINS];
        let mut quotients = [simd.splat_f64s(black_box(1.0)); DIVISIONS];
        let started = Instant::now();
        for _ in 0..STEPS {
            for chain in &mut quotients {
                *chain = simd.div_f64s(factor, *chain);
            }
            for _ in 0..ROUNDS {
                for chain in &mut sums {
                    *chain = simd.mul_add_f64s(*chain, factor, factor);
                }
            }
        }
        let seconds = started.elapsed().as_secs_f64();
        for chain in sums.into_iter().chain(quotients) {
            black_box(simd.reduce_sum_f64s(chain));
        }
        (STEPS * S::F64_LANES) as f64 / seconds
    }
}
