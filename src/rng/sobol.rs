//! Points that fill the cube evenly: one set of four-dimensional points for every block, scrambled at random.
//!
//! ```text
//! n          number of the sample                       a₀ + 2 a₁ + 4 a₂ + …, a bit per digit
//! i = σ(n)   shuffled: bit j of n is flipped or not, as a hash of the bits above it says
//! x_d        0.b₁b₂b₃… with b = C_d a(i) (mod 2)        C₀ = 1, C₁ = P, C₂ = U, C₃ = P U
//! u_d        x_d scrambled (Owen 1995): bit k is flipped or not, as a hash of b₁ … b_{k−1} says
//! P_ij = binomial(j, i) mod 2          U_ij = binomial(j, i) ω^{j−i} over the field of four elements {0, 1, ω, ω²}, two bits each
//! ```
//! C₀ and C₁ are Sobol's first two dimensions (Sobol 1967): the first 2^m points are a (0,m,2)-net. With four elements there is
//! room for four dimensions as good (Faure 1982, Niederreiter 1987): 1, P^(1), U = P^(ω) and P^(1)P^(ω) = P^(1+ω) = P^(ω²) are a
//! (0,4)-sequence in base 4, up to bijections of a digit's bits, which change no net. So of the first 4^m points exactly one lies in
//! every box of volume 4^−m whose sides are powers of 1/4, whichever of the four numbers it is a box of; and the pairs (0, 1) and
//! (2, 3), which are (C, P C) with the same C, are (0,m,2)-nets in base 2 for *every* m (the form of Hofer & Suzuki 2019). Joe and
//! Kuo's third and fourth dimensions have neither property. Aligned runs of 2^m later samples have the same.
//!
//! Each block of each pixel has keys of its own. Scrambling makes every number uniform by itself, whatever the others: a mean of N
//! samples is unbiased for every N. Shuffling parts the blocks ("padding"): without it, the samples of two blocks would come in the
//! same order. One tie is left, as two samples must already be even: 2i and 2i + 1 lie in opposite halves of every number of every block, so
//! that half as many *pairs of halves* of two blocks are independent. Shuffles that loosen it, by the affine maps of the fields
//! of 4 or 16 elements on the lowest bits, were tried: pictures had 2 % less noise at best, from 16 samples on, and up to 20 % more below.
//!
//! Both are "nested uniform" permutations by the hash of Laine and Karras (2011) in Vegdahl's form (2021), as in Burley (2020,
//! "Practical Hash-based Owen Scrambling"): in a word whose bits are reversed, sums and products carry from a bit to those after it
//! only. All is kept reversed, so that a word is turned round once on its way in and once on its way out.
//!
//! Twin: shaders/rng/sobol.wgsl.

use super::pcg4d;

/// In the place of the sample's number, where the keys are drawn: no sample has it.
const KEYS: u32 = u32::MAX;

/// The words of four scrambled numbers: sample `sample` of the set that the keys choose.
#[inline]
pub fn sobol_words(sample: u32, keys: [u32; 4]) -> [u32; 4] {
    let [k0, k1, k2, k3] = keys;
    let order = k0 ^ k1.rotate_left(8) ^ k2.rotate_left(16) ^ k3.rotate_left(24);
    let [x0, x1, x2, x3] = point_of_reversed(owen_scramble(sample.reverse_bits(), order));
    [
        owen_scramble(x0, k0).reverse_bits(),
        owen_scramble(x1, k1).reverse_bits(),
        owen_scramble(x2, k2).reverse_bits(),
        owen_scramble(x3, k3).reverse_bits(),
    ]
}

/// The keys of a pixel's block.
#[inline]
pub fn sobol_keys(pixel: u32, seed: u32, block: u32) -> [u32; 4] {
    pcg4d([pixel, KEYS, seed, block])
}

/// What four bits of a reversed index add to the point: [where they are][what they are].
static PARTS: [[[u32; 4]; 16]; 8] = {
    let mut parts = [[[0; 4]; 16]; 8];
    let mut n = 0;
    while n < 128 {
        let bits = (n as u32 & 15) << (n / 16 * 4);
        parts[n / 16][n % 16] = sobol_point(bits.reverse_bits());
        n += 1;
    }
    parts
};

/// [`sobol_point`] of the index with these bits turned round, from its parts: faster on a processor.
#[inline(always)]
fn point_of_reversed(bits: u32) -> [u32; 4] {
    let part = |place: usize| PARTS[place][(bits >> (4 * place) & 15) as usize];
    let plus = |a: [u32; 4], b: [u32; 4]| [a[0] ^ b[0], a[1] ^ b[1], a[2] ^ b[2], a[3] ^ b[3]];
    let pair = |place: usize| plus(part(place), part(place + 1));
    plus(plus(pair(0), pair(2)), plus(pair(4), pair(6)))
}

/// Point number `index` of the set: the bits of each coordinate, the first in the lowest place.
#[inline]
pub const fn sobol_point(index: u32) -> [u32; 4] {
    let over = pascal_over_four(index);
    [index, pascal(index), over, pascal(over)]
}

/// P v: the matrix is the fifth Kronecker power of ((1, 1), (0, 1)).
#[inline]
pub const fn pascal(v: u32) -> u32 {
    let v = v ^ (v & 0xAAAA_AAAA) >> 1;
    let v = v ^ (v & 0xCCCC_CCCC) >> 2;
    let v = v ^ (v & 0xF0F0_F0F0) >> 4;
    let v = v ^ (v & 0xFF00_FF00) >> 8;
    v ^ v >> 16
}

/// U v, two bits a digit: the product of ((1, ω^n), (0, 1)) over the digits' distances n = 1, 2, 4, 8, where ω⁴ = ω.
#[inline]
pub const fn pascal_over_four(v: u32) -> u32 {
    let v = v ^ times_omega((v & 0xCCCC_CCCC) >> 2);
    let v = v ^ times_omega(times_omega((v & 0xF0F0_F0F0) >> 4));
    let v = v ^ times_omega((v & 0xFF00_FF00) >> 8);
    v ^ times_omega(times_omega(v >> 16))
}

/// ω times each digit: ω (2 a + b) = ω (a ω + b) = (a + b) ω + a, as ω² = ω + 1.
#[inline]
const fn times_omega(v: u32) -> u32 {
    (v >> 1 & 0x5555_5555) | ((v ^ v << 1) & 0xAAAA_AAAA)
}

/// Flips each bit of a reversed word or not, as a hash of the bits below it and the key says.
#[inline]
pub fn owen_scramble(bits: u32, key: u32) -> u32 {
    let x = bits ^ bits.wrapping_mul(0x3D20_ADEA);
    let x = x.wrapping_add(key).wrapping_mul(key >> 16 | 1);
    let x = x ^ x.wrapping_mul(0x0552_6C56);
    x ^ x.wrapping_mul(0x53A2_2864)
}

#[cfg(test)]
mod tests;
