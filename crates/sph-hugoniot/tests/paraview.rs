//! Moments for ParaView: written, listed, bounded, and read back by VTK itself where Python has it.

use std::path::Path;
use std::process::Command;

/// Reads each moment of a series with VTK and holds it against what it should be.
const READER: &str = r#"
import os, sys, xml.etree.ElementTree as tree, vtk
path = sys.argv[1]
for entry in tree.parse(path).getroot().iter("DataSet"):
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(os.path.join(os.path.dirname(path), entry.get("file")))
    reader.Update()
    data = reader.GetOutput()
    n, arrays = data.GetNumberOfPoints(), data.GetPointData()
    assert n > 100 and data.GetNumberOfVerts() == n, n
    time = data.GetFieldData().GetArray("TimeValue").GetValue(0)
    assert time == float(entry.get("timestep")), time
    stress, velocity = arrays.GetArray("stress [Pa]"), arrays.GetArray("velocity [m/s]")
    names = [stress.GetComponentName(k) for k in range(6)]
    assert names == ["XX", "YY", "ZZ", "XY", "YZ", "XZ"], names
    assert velocity.GetNumberOfComponents() == 3
    low, high = arrays.GetArray("density [kg/m3]").GetRange()
    assert 8000 < low < high < 10000, (low, high)
    print(entry.get("file"), n)
"#;

fn run(folder: &Path, snapshots: &str) {
    let smoke = sph_hugoniot::template::text("smoke").unwrap();
    let case = smoke
        .replace("max_fed_cells: 12", "max_fed_cells: 6")
        .replace("Cells(4)", "Cells(2)")
        .replace("\"results/smoke\"", &format!("\"out\", snapshots: {snapshots}"));
    std::fs::write(folder.join("case.ron"), case).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_hugoniot"));
    let arguments = ["run", "case.ron", "--up", "300", "--threads", "1", "--quiet"];
    assert!(command.current_dir(folder).args(arguments).status().unwrap().success());
}

#[test]
fn moments_are_listed_and_read_back_by_vtk() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), "Every(cells: 2.0)");
    let series = folder.path().join("out/points/up_0300/snapshots/snapshots.pvd");
    let list = std::fs::read_to_string(&series).unwrap();
    let n = list.matches("<DataSet").count();
    assert!((2..=6).contains(&n), "{list}");
    let reader = folder.path().join("reader.py");
    std::fs::write(&reader, READER).unwrap();
    let python = std::env::var("SPH_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let has_vtk = Command::new(&python).args(["-c", "import vtk"]).output().is_ok_and(|o| o.status.success());
    if !has_vtk {
        println!("skipped: {python} has no vtk (pip install vtk; SPH_PYTHON names another Python)");
        return;
    }
    let output = Command::new(&python).arg(&reader).arg(&series).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), n);
}

#[test]
fn the_limit_holds_and_is_told() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), "Every(cells: 0.5, limit_mb: 0.1)");
    let point = folder.path().join("out/points/up_0300/snapshots");
    let files = std::fs::read_dir(point).unwrap().map(|entry| entry.unwrap());
    let bytes: u64 = files
        .filter(|file| file.path().extension().is_some_and(|e| e == "vtp"))
        .map(|file| file.metadata().unwrap().len())
        .sum();
    assert!((10_000..=100_000).contains(&bytes), "{bytes}");
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(page.contains("limit_mb met after"), "the limit is told");
}
