/* The hardware's limit: velocity Verlet on chains of Hertz contacts, all beads stepped, fixed step, no options.
 *
 * Written as well as we can, for ratios only: constants of the step are folded into the table beforehand, and
 * the square root of lanes is the machine's estimate of 1/sqrt with one Newton step (4e-9) where it has one.
 */
#include <math.h>
#include <string.h>
#if defined(__AVX512F__)
#include <immintrin.h>
#endif

#define LANES 8
#define BLOCK 512
enum { U, V, K, G, COLUMNS }; /* displacement, velocity, Hertz constant of the contact behind, step/mass */

typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef lanes unaligned __attribute__((aligned(8)));

static inline lanes hertz(lanes x, lanes stiffness)
{
#if defined(__AVX512F__)
    const __m512d half = _mm512_set1_pd(0.5), threehalves = _mm512_set1_pd(1.5);
    __m512d d = (__m512d)x;
    __mmask8 touching = _mm512_cmp_pd_mask(d, _mm512_setzero_pd(), _CMP_GT_OQ);
    __m512d y = _mm512_maskz_rsqrt14_pd(touching, d);
    __m512d r = _mm512_mul_pd(d, y);
    /* r (3 - r y)/2: Newton's step for the root itself */
    __m512d w = _mm512_fnmadd_pd(_mm512_mul_pd(half, r), y, threehalves);
    return (lanes)_mm512_mul_pd(_mm512_mul_pd((__m512d)stiffness, d), _mm512_mul_pd(r, w));
#else
    lanes force;
    for (int k = 0; k < LANES; k++) {
        double d = x[k] > 0.0 ? x[k] : 0.0;
        force[k] = stiffness[k] * d * sqrt(d);
    }
    return force;
#endif
}

/* state (groups, bodies, COLUMNS, LANES), positions half a step behind on entry and on return;
 * out (groups, samples, LANES): force of one contact after every `every` steps. */
void verlet_lanes(long groups, long bodies, long samples, long every, double step, long contact, double *state,
                  double *out)
{
    for (long g = 0; g < groups; g++) {
        lanes *b = (lanes *)state + g * bodies * COLUMNS;
        lanes *written = (lanes *)out + g * samples;
        for (long s = 0; s < samples; s++) {
            for (long n = 0; n < every; n++) {
                lanes pull = {0}, v = b[V], x = b[U] + step * v;
                for (long i = 0; i < bodies - 1; i++) {
                    lanes *here = b + i * COLUMNS, *next = here + COLUMNS;
                    lanes ahead_v = next[V], ahead = next[U] + step * ahead_v;
                    lanes push = hertz(x - ahead, here[K]);
                    here[U] = x;
                    here[V] = v + here[G] * (pull - push);
                    pull = push;
                    x = ahead;
                    v = ahead_v;
                }
                lanes *last = b + (bodies - 1) * COLUMNS;
                last[U] = x;
                last[V] = v + last[G] * (pull - hertz(x, last[K]));
            }
            lanes *c = b + contact * COLUMNS, *d = c + COLUMNS;
            lanes half = {0};
            half += 0.5 * step;
            lanes x = c[U] + half * c[V];
            written[s] = hertz(contact < bodies - 1 ? x - d[U] - half * d[V] : x, c[K]);
        }
    }
}

/* One chain, arrays of `bodies` + LANES + 1 (beyond the last body: zeros), eight bodies at a time, in blocks that
 * stay in the first cache. */
void verlet_chain(long bodies, long samples, long every, double step, long contact, double *restrict u,
                  double *restrict v, const double *restrict k, const double *restrict g, double *restrict out)
{
    double room[BLOCK + 2 * LANES] __attribute__((aligned(64)));
    double *force = room + LANES - 1; /* so that force + 1 is aligned */
    for (long i = 0; i < bodies; i++) u[i] += step * v[i]; /* positions of the middle of the step */
    for (long s = 0; s < samples; s++) {
        for (long n = 0; n < every; n++) {
            double before = 0.0;
            for (long start = 0; start < bodies; start += BLOCK) {
                long size = bodies - start < BLOCK ? bodies - start : BLOCK;
                force[0] = before;
                for (long i = 0; i < size; i += LANES) {
                    lanes d = *(unaligned *)(u + start + i) - *(unaligned *)(u + start + i + 1);
                    *(unaligned *)(force + i + 1) = hertz(d, *(unaligned *)(k + start + i));
                }
                before = force[size];
                for (long i = 0; i < size; i += LANES) {
                    lanes change = *(unaligned *)(force + i) - *(unaligned *)(force + i + 1);
                    lanes speed = *(unaligned *)(v + start + i) + *(unaligned *)(g + start + i) * change;
                    *(unaligned *)(v + start + i) = speed;
                    *(unaligned *)(u + start + i) += step * speed;
                }
            }
        }
        double d = u[contact] - u[contact + 1] - 0.5 * step * (v[contact] - v[contact + 1]);
        d = d > 0.0 ? d : 0.0;
        out[s] = k[contact] * d * sqrt(d);
    }
}

/* The same with one body at a time, kick and drift fused: better where most bodies are at rest, as the square root
 * of zero is fast. */
void verlet_chain_scalar(long bodies, long samples, long every, double step, long contact, double *restrict u,
                         double *restrict v, const double *restrict k, const double *restrict g,
                         double *restrict out)
{
    for (long s = 0; s < samples; s++) {
        for (long n = 0; n < every; n++) {
            double pull = 0.0, speed = v[0], x = u[0] + step * speed;
            for (long i = 0; i < bodies; i++) {
                double ahead_speed = v[i + 1], ahead = u[i + 1] + step * ahead_speed, d = x - ahead;
                d = d > 0.0 ? d : 0.0;
                double push = k[i] * d * sqrt(d);
                u[i] = x;
                v[i] = speed + g[i] * (pull - push);
                pull = push;
                x = ahead;
                speed = ahead_speed;
            }
        }
        double d = u[contact] - u[contact + 1] + 0.5 * step * (v[contact] - v[contact + 1]);
        d = d > 0.0 ? d : 0.0;
        out[s] = k[contact] * d * sqrt(d);
    }
}
