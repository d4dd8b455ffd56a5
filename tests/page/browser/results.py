"""Prints what a results file holds of the light, as JSON, for the tests of the page.

python3 results.py FILE.h5 [--dense]: with --dense also F as rows and the solution by LAPACK, an independent method.
"""
import json
import sys

import h5py
import numpy as np


def dense_matrix(group):
    size = group["shape"][0]
    matrix = np.zeros((size, size))
    begin = group["indptr"][()]
    for i in range(size):
        row = slice(begin[i], begin[i + 1])
        matrix[i, group["indices"][row]] = group["data"][row]
    return matrix


def dense_solution(matrix, emission, reflectance):
    columns = [np.linalg.solve(np.eye(len(matrix)) - reflectance[:, [b]] * matrix, emission[:, b])
               for b in range(emission.shape[1])]
    return np.stack(columns, axis=1)


def main():
    with h5py.File(sys.argv[1]) as file:
        if "gather" in file:
            light = file["gather"]
            gathered = {name: light[name][()].ravel().tolist() for name in ("irradiance", "position")}
            json.dump({"gathered": gathered}, sys.stdout)
            return
        if "heat" in file:
            heat = file["heat"]
            out = {name: heat[name][()].ravel().tolist() for name in ("temperature", "radiosity", "net_flux")}
            out["area"] = file["form_factors/area"][()].tolist()
            out["factors"] = dense_matrix(file["form_factors"]).tolist()
            out["surface"] = file["form_factors/surface"][()].tolist()
            json.dump(out, sys.stdout)
            return
        light = file["solution"]
        out = {name: light[name][()].ravel().tolist()
               for name in ("emission", "reflectance", "irradiance", "radiosity")}
        factors = file["form_factors"]
        out["area"] = factors["area"][()].tolist()
        out["surface"] = [factors["surface_names"][()][k].decode() for k in factors["surface"][()]]
        if "row_sum" in factors:  # not of rows that are cut
            out["rowSum"] = factors["row_sum"][()].tolist()
        out["history"] = light["summary/residual_history"][()].tolist()
        if "--dense" in sys.argv:
            matrix = dense_matrix(factors)
            out["factors"] = matrix.tolist()
            out["solved"] = dense_solution(matrix, light["emission"][()], light["reflectance"][()]).ravel().tolist()
    json.dump(out, sys.stdout)


main()
