/* DOP853 (Dormand & Prince, order 8(5,3), step control of Hairer, Norsett & Wanner) with a compiled right-hand
 * side: what a general-purpose integrator can do at best. Coefficients come from the caller (scipy's tables).
 * Samples by its own dense output.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define STAGES 12
#define EXTENDED 16 /* with the stages of the dense output */

typedef struct {
    long bodies, calls;
    const double *k, *inverse_mass;
} chain;

static void motion(chain *c, const double *y, double *f)
{
    long n = c->bodies;
    double pull = 0.0;
    for (long i = 0; i < n; i++) {
        double d = y[i] - (i + 1 < n ? y[i + 1] : 0.0);
        d = d > 0.0 ? d : 0.0;
        double push = c->k[i] * d * sqrt(d);
        f[i] = y[n + i];
        f[n + i] = (pull - push) * c->inverse_mass[i];
        pull = push;
    }
    c->calls++;
}

/* Displacement of one body at the fraction s of a step, by the seventh-order polynomial of the extended stages. */
static double dense(const double *y, const double *x, const double *f, long n, long i, const double *d, double h, double s)
{
    double step = x[i] - y[i], part[7] = {step, h * f[i] - step, 2 * step - h * (f[STAGES * n + i] + f[i])};
    for (int m = 0; m < 4; m++) {
        double sum = 0.0;
        for (int j = 0; j < EXTENDED; j++) sum += d[m * EXTENDED + j] * f[j * n + i];
        part[3 + m] = h * sum;
    }
    double value = 0.0;
    for (int m = 6; m >= 0; m--) value = (value + part[m]) * (m % 2 == 0 ? s : 1.0 - s);
    return y[i] + value;
}

/* a (EXTENDED, EXTENDED), b, e3, e5 (STAGES + 1), d (4, EXTENDED); y (2 bodies) at time 0, scale (2 bodies) of absolute tolerances;
 * out (samples, recorded). Returns the calls of the right-hand side. */
long dop853(long bodies, const double *k, const double *inverse_mass, double *y, const double *a, const double *b,
            const double *e3, const double *e5, const double *d, double rtol, const double *atol, double first, double interval,
            long samples, long recorded, const long *contacts, double *out)
{
    long n = 2 * bodies, sample = 1;
    chain c = {bodies, 0, k, inverse_mass};
    double *f = malloc(sizeof(double) * n * EXTENDED), *x = malloc(sizeof(double) * n),
           *z = malloc(sizeof(double) * n);
    double t = 0.0, h = first, end = (samples - 1) * interval;
    memset(out, 0, sizeof(double) * recorded);
    motion(&c, y, f);
    int rejected = 0;
    while (sample < samples) {
        if (t + h > end * (1 + 1e-12)) h = end * (1 + 1e-12) - t;
        for (int s = 1; s < STAGES; s++) {
            for (long i = 0; i < n; i++) {
                double sum = 0.0;
                for (int j = 0; j < s; j++) sum += a[s * EXTENDED + j] * f[j * n + i];
                x[i] = y[i] + h * sum;
            }
            motion(&c, x, f + s * n);
        }
        for (long i = 0; i < n; i++) {
            double sum = 0.0;
            for (int j = 0; j < STAGES; j++) sum += b[j] * f[j * n + i];
            x[i] = y[i] + h * sum;
        }
        motion(&c, x, f + STAGES * n);
        double sum3 = 0.0, sum5 = 0.0;
        for (long i = 0; i < n; i++) {
            double scale = atol[i] + rtol * fmax(fabs(y[i]), fabs(x[i])), r3 = 0.0, r5 = 0.0;
            for (int j = 0; j <= STAGES; j++) {
                r3 += e3[j] * f[j * n + i];
                r5 += e5[j] * f[j * n + i];
            }
            sum3 += r3 * r3 / (scale * scale);
            sum5 += r5 * r5 / (scale * scale);
        }
        double error = sum5 > 0.0 ? fabs(h) * sum5 / sqrt((sum5 + 0.01 * sum3) * n) : 0.0;
        double factor = error > 0.0 ? 0.9 * pow(error, -0.125) : 10.0;
        if (error >= 1.0) {
            h *= fmax(0.2, factor);
            rejected = 1;
            continue;
        }
        int sampled = sample < samples && sample * interval <= t + h * (1 + 1e-9);
        for (int s = STAGES + 1; sampled && s < EXTENDED; s++) {
            for (long i = 0; i < n; i++) {
                double sum = 0.0;
                for (int j = 0; j < s; j++) sum += a[s * EXTENDED + j] * f[j * n + i];
                z[i] = y[i] + h * sum;
            }
            motion(&c, z, f + s * n);
        }
        for (; sample < samples && sample * interval <= t + h * (1 + 1e-9); sample++)
            for (long r = 0; r < recorded; r++) {
                long q = contacts[r];
                double part = (sample * interval - t) / h;
                double delta = dense(y, x, f, n, q, d, h, part);
                if (q + 1 < bodies) delta -= dense(y, x, f, n, q + 1, d, h, part);
                delta = delta > 0.0 ? delta : 0.0;
                out[sample * recorded + r] = k[q] * delta * sqrt(delta);
            }
        t += h;
        memcpy(y, x, sizeof(double) * n);
        memcpy(f, f + STAGES * n, sizeof(double) * n);
        h *= fmin(rejected ? 1.0 : 10.0, fmax(0.2, factor));
        rejected = 0;
    }
    free(f);
    free(x);
    free(z);
    return c.calls;
}
