/* Frames a second of Mesa's GLU NURBS on a scene of `gpu-bench --scene`, off screen (OSMesa): half a pixel of error as GLU
 * understands it, or so many steps along each side of every surface.
 *
 * GLU samples every surface anew for every frame, on the CPU, and trims by tessellating in the parameters. Normals are GLU's own
 * (GL_AUTO_NORMAL). Prints: surfaces, width, height, seconds of the fastest frame, frames a second, shaded pixels.
 *
 * usage: glu_bench SCENE WIDTH HEIGHT STEPS [OUT.ppm]      STEPS 0: by the error */

#include <GL/glu.h>
#include <GL/osmesa.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* No measurement goes on for longer, unless one frame does. */
#define PATIENCE 2.0
#define MOST_FRAMES 20

typedef struct { int count; GLfloat *points; } Loop;
typedef struct { int counts[2]; GLfloat *knots[2], *points; int loops; Loop *loop; } Sheet;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static void fail(const char *what)
{
    fprintf(stderr, "glu_bench: %s\n", what);
    exit(2);
}

static GLfloat *numbers(FILE *file, int count)
{
    GLfloat *all = malloc(sizeof(GLfloat) * (count > 0 ? count : 1));
    if (!all) fail("out of memory");
    for (int k = 0; k < count; k++)
        if (fscanf(file, "%f", &all[k]) != 1) fail("the scene is cut off");
    return all;
}

static int number(FILE *file)
{
    int n;
    if (fscanf(file, "%d", &n) != 1 || n < 0) fail("the scene is cut off");
    return n;
}

static void read_sheet(FILE *file, Sheet *s)
{
    s->counts[0] = number(file);
    s->counts[1] = number(file);
    for (int k = 0; k < 2; k++) s->knots[k] = numbers(file, s->counts[k] + 4);
    s->points = numbers(file, 4 * s->counts[0] * s->counts[1]);
    s->loops = number(file);
    s->loop = malloc(sizeof(Loop) * (s->loops > 0 ? s->loops : 1));
    if (!s->loop) fail("out of memory");
    for (int k = 0; k < s->loops; k++) {
        s->loop[k].count = number(file) + 1;
        GLfloat *points = malloc(2 * sizeof(GLfloat) * s->loop[k].count);
        if (!points) fail("out of memory");
        for (int i = 0; i < 2 * (s->loop[k].count - 1); i++)
            if (fscanf(file, "%f", &points[i]) != 1) fail("the scene is cut off");
        /* Loops of GLU end where they began. */
        points[2 * s->loop[k].count - 2] = points[0];
        points[2 * s->loop[k].count - 1] = points[1];
        s->loop[k].points = points;
    }
}

static int errors;

static void count_error(GLenum code)
{
    (void)code;
    errors++;
}

static void trim(GLUnurbs *nurbs, GLfloat *points, int count)
{
    gluBeginTrim(nurbs);
    gluPwlCurve(nurbs, count, points, 2, GLU_MAP1_TRIM_2);
    gluEndTrim(nurbs);
}

static void draw(GLUnurbs *nurbs, const Sheet *sheets, int count)
{
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    for (int k = 0; k < count; k++) {
        const Sheet *s = &sheets[k];
        gluBeginSurface(nurbs);
        gluNurbsSurface(nurbs, s->counts[0] + 4, s->knots[0], s->counts[1] + 4, s->knots[1], 4 * s->counts[1], 4,
                        s->points, 4, 4, GL_MAP2_VERTEX_4);
        for (int i = 0; i < s->loops; i++) trim(nurbs, s->loop[i].points, s->loop[i].count);
        gluEndSurface(nurbs);
    }
    glFinish();
}

static void set_up(const GLfloat *box, int width, int height)
{
    double centre[2], half = 0;
    for (int k = 0; k < 2; k++) {
        double size = 0.5 * (box[3 + k] - box[k]) * (k == 0 ? (double)height / width : 1.0);
        centre[k] = 0.5 * (box[k] + box[3 + k]);
        if (size > half) half = size;
    }
    half *= 1.05;
    double wide = half * width / height, depth = box[5] - box[2] + 1.0;
    glViewport(0, 0, width, height);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    /* From above: the eye looks along -z. */
    glOrtho(centre[0] - wide, centre[0] + wide, centre[1] - half, centre[1] + half, -box[5] - depth, -box[2] + depth);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glEnable(GL_AUTO_NORMAL);
    glEnable(GL_NORMALIZE);
    glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, GL_TRUE);
}

int main(int argc, char **argv)
{
    if (argc < 5) fail("usage: glu_bench SCENE WIDTH HEIGHT STEPS [OUT.ppm]");
    FILE *file = fopen(argv[1], "r");
    if (!file) fail("cannot read the scene");
    int width = atoi(argv[2]), height = atoi(argv[3]), count = number(file);
    if (width < 1 || height < 1) fail("no such size");
    GLfloat *box = numbers(file, 6);
    Sheet *sheets = malloc(sizeof(Sheet) * (count > 0 ? count : 1));
    if (!sheets) fail("out of memory");
    for (int k = 0; k < count; k++) read_sheet(file, &sheets[k]);
    fclose(file);

    OSMesaContext context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 0, 0, NULL);
    unsigned char *pixels = calloc((size_t)width * height, 4);
    if (!context || !pixels || !OSMesaMakeCurrent(context, pixels, GL_UNSIGNED_BYTE, width, height))
        fail("no off-screen context");
    fprintf(stderr, "%s, GLU %s\n", (const char *)glGetString(GL_RENDERER), (const char *)gluGetString(GLU_VERSION));
    set_up(box, width, height);
    GLUnurbs *nurbs = gluNewNurbsRenderer();
    gluNurbsCallback(nurbs, GLU_ERROR, (_GLUfuncptr)count_error);
    float steps = (float)atof(argv[4]);
    if (steps > 0) {
        gluNurbsProperty(nurbs, GLU_SAMPLING_METHOD, GLU_DOMAIN_DISTANCE);
        gluNurbsProperty(nurbs, GLU_U_STEP, steps);
        gluNurbsProperty(nurbs, GLU_V_STEP, steps);
    } else {
        gluNurbsProperty(nurbs, GLU_SAMPLING_METHOD, GLU_PARAMETRIC_ERROR);
        gluNurbsProperty(nurbs, GLU_PARAMETRIC_TOLERANCE, 0.5f);
    }

    double began = now(), best = 1e300;
    for (int frame = 0; frame < MOST_FRAMES && (frame == 0 || now() - began < PATIENCE); frame++) {
        double started = now();
        draw(nurbs, sheets, count);
        double seconds = now() - started;
        if (seconds < best) best = seconds;
    }
    long shaded = 0;
    for (long k = 0; k < (long)width * height; k++) shaded += pixels[4 * k] + pixels[4 * k + 1] + pixels[4 * k + 2] > 0;
    printf("%d %d %d %.4f %.2f %ld\n", count, width, height, best, 1.0 / best, shaded);
    if (errors) fprintf(stderr, "glu_bench: GLU reported %d errors\n", errors);
    if (argc > 5) {
        FILE *out = fopen(argv[5], "wb");
        if (!out) fail("cannot write the picture");
        fprintf(out, "P6\n%d %d\n255\n", width, height);
        for (int y = height - 1; y >= 0; y--)
            for (int x = 0; x < width; x++) fwrite(&pixels[4 * ((size_t)y * width + x)], 1, 3, out);
        fclose(out);
    }
    return 0;
}
