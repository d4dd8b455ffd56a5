"""The program's files read by other libraries: h5py, scipy, numpy."""

import os
import subprocess
import tempfile
import unittest

import h5py
import numpy as np
import scipy.io
import scipy.sparse

PROGRAM = os.environ["RADIOSITY"]
DATA = os.path.join(os.environ["RADIOSITY_SOURCE_DIR"], "data")


def run(*arguments):
    """Runs the program; its output if it exits with another code than 0."""
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(arguments)}: {done.returncode}\n{done.stdout}{done.stderr}")


def csr(group):
    matrix = scipy.sparse.csr_matrix(
        (group["data"][:], group["indices"][:], group["indptr"][:]), shape=tuple(group["shape"])
    )
    matrix.check_format(full_check=True)
    return matrix


class ResultsTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def factors(self, scene, *options):
        """Form factors of a scene of data/, as results file and as MatrixMarket."""
        run("factors", os.path.join(DATA, scene), "--method", "hemicube", *options, "-o", self.path("x.h5"), "-o",
            self.path("x.mtx"))

    def test_scipy_reads_the_matrix(self):
        self.factors("furnace-cube.obj", "--patches", "96", "--resolution", "64")
        with h5py.File(self.path("x.h5"), "r") as file:
            group = file["form_factors"]
            self.assertEqual(group["data"].dtype, np.float32)
            self.assertEqual(group["indices"].dtype, np.int32)
            self.assertEqual(group["indptr"].dtype, np.int64)
            matrix = csr(group)
            self.assertTrue(matrix.has_sorted_indices)
            n = matrix.shape[0]
            sums = np.asarray(matrix.astype(np.float64).sum(axis=1)).ravel()
            # The same up to 96 roundings of sums near 1, in another order.
            np.testing.assert_allclose(sums, group["row_sum"][:], rtol=0, atol=1e-14)
            # fronts is counted before values are rounded to 32 bits (6e-8 relative).
            np.testing.assert_allclose(sums, group["fronts"][:], rtol=0, atol=1e-7)
            accounts = group["fronts"][:] + group["backs"][:] + group["sky"][:]
            # Three sums of at most 64 * 64 * 3 pixel weights, which sum to 1 within 1e-14.
            np.testing.assert_allclose(accounts, np.ones(n), rtol=0, atol=1e-12)
            for name, shape in (("area", (n,)), ("normal", (n, 3)), ("centroid", (n, 3))):
                self.assertEqual(group[name].shape, shape)
            self.assertAlmostEqual(group["area"][:].sum(), 6.0, delta=1e-12)  # the unit cube
            names = group["surface_names"].asstr()[:]
            self.assertEqual(len(names), 6)
            self.assertIn("cube_floor/wall", names)
            self.assertLess(group["surface"][:].max(), 6)
            # The floor sees nothing of itself: it is flat.
            floor = group["surface"][:] == list(names).index("cube_floor/wall")
            self.assertEqual(matrix[floor][:, floor].nnz, 0)
            self.assertEqual(group.attrs["method"], b"hemicube")
            self.assertEqual(group["area"].attrs["unit"], b"m^2")
            self.assertEqual(group.attrs["geometry_hash"], file["mesh"].attrs["geometry_hash"])
            self.assertTrue(file.attrs["version"])

    def test_matrix_market_is_the_same_matrix(self):
        for precision in ("single", "double"):
            self.factors("cornell-box.obj", "--patches", "200", "--resolution", "32", "--precision",
                         precision)
            market = scipy.io.mmread(self.path("x.mtx")).tocsr()
            market.sort_indices()
            with h5py.File(self.path("x.h5"), "r") as file:
                matrix = csr(file["form_factors"])
                expected = np.float32 if precision == "single" else np.float64
                self.assertEqual(matrix.dtype, expected)
                np.testing.assert_array_equal(market.indptr, matrix.indptr)
                np.testing.assert_array_equal(market.indices, matrix.indices)
                np.testing.assert_array_equal(market.data, matrix.data.astype(np.float64))

    def test_solution_solves_the_stored_system(self):
        self.factors("cornell-box.obj", "--patches", "200", "--resolution", "32")
        run("solve", self.path("x.h5"), "--solve-tolerance", "1e-10")
        with h5py.File(self.path("x.h5"), "r") as file:
            matrix = csr(file["form_factors"]).toarray().astype(np.float64)
            solution = file["solution"]
            self.assertEqual(solution["summary"].attrs["status"], b"converged")
            for band in range(3):
                reflectance = solution["reflectance"][:, band]
                emission = solution["emission"][:, band]
                radiosity = np.linalg.solve(
                    np.eye(len(matrix)) - reflectance[:, None] * matrix, emission
                )
                # The residual is below 1e-10 max E; (I - rho F)^-1 enlarges it by less than
                # 1 / (1 - max rho) < 10 in this scene.
                limit = 1e-9 * emission.max()
                np.testing.assert_allclose(solution["radiosity"][:, band], radiosity, rtol=0,
                                           atol=limit)
                np.testing.assert_allclose(solution["irradiance"][:, band], matrix @ radiosity,
                                           rtol=0, atol=limit)


if __name__ == "__main__":
    unittest.main()
